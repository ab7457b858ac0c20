"""Pictures and curves of docs/recipes."""

from pictures import Picture

RECIPES = (
    Picture("recipes/beam", "", contents="solids,stress", settings=("E=20 MPa", "output.frames=20 ms"),
            draw="--elevation 8 --grains radius"),
    Picture("recipes/footing", "", contents="solids,stress,history", settings=("output.frames=50 ms",),
            draw="--solids plastic_strain --azimuth 12 --elevation 15"),
    Picture("recipes/oedometer", "", contents="contacts", settings=("output.frames=1 ms",), draw="--lines contacts"),
    Picture("recipes/repose", "", draw="--azimuth 10 --elevation 10 --grains radius"),
    Picture("recipes/shear", "", draw="--azimuth 10 --elevation 12"),
    Picture("recipes/triaxial", "", contents="contacts", settings=("output.frames=50 ms",), draw="--lines contacts"),
    Picture("recipes/wave", "", settings=("output.frames=2 ms",), frame=0.5, draw="--solids speed"),
)
