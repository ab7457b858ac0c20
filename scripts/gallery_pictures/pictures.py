"""What the gallery shows: which scene, which instant, drawn how, and what to look at."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Picture:
    scene: str
    look: str  # what to look at, Markdown
    frame: float = 1.0  # which of the frames, as a fraction of the run
    settings: tuple = ()  # --set of the run
    contents: str = ""  # of the frames, where the scene's own are not what is drawn
    draw: str = ""  # options of dovetail picture
    animated: bool = False
    name: str = ""
    lines: tuple = ()  # of the scene, shown beside the picture: the values that begin on the first lines with these texts
    long: str = ""  # run time, where it is more than half a minute
    after: str = ""  # scene whose run this one continues
    heading: str = ""  # the scene's title if not given

    @property
    def file(self):
        return self.name or self.scene

    @property
    def image(self):
        """Below docs/images, without ending."""
        return self.file if self.scene.startswith("recipes/") else f"gallery/{self.file}"


PICTURES = (
    Picture("plate", "The plate bends under the layer; stress is largest at the clamp, and beads at the rim move up.",
            frame=0.45, draw="--azimuth -19 --elevation 25", lines=('"particles"', '"solids"', '"couplings"')),
    Picture("tray", "The rubber sags under the weight; stress is largest along the two clamped sides.",
            lines=('"insertions"', '"sets"', '"supports"', '"couplings"')),
    Picture("tray-tilted", "The filled plate, tilted by 20°: the grains slide to one side, and the plate sags there.",
            lines=('"gravity"', '"particles"', '"state": {'), after="tray"),
    Picture("pile", "Plastic strain of the clay: the dents of the first impacts remain.",
            contents="solids,stress,history", draw="--solids plastic_strain --elevation 32",
            lines=('"material": {"law": "J2"', '"formulation"', '"couplings"')),
    Picture("footing", "Section: grain weights fall from 1 to 0 through the overlap; soil weights rise from 0 to 1.",
            contents="solids,stress,weights", draw="--grains weight --solids solid_weight --cut y 0.115",
            lines=('"couplings"',)),
    Picture("footing", "Force chains carry the load of the plate down to the overlap; in the soil it is stress.",
            contents="contacts,solids,stress", draw="--lines contacts --uncut",
            name="footing-forces", heading="Force chains under the plate",
            lines=('{"on": "z+", "velocity"', '"law": "Drucker-Prager"')),
    Picture("oedometer", "The lid presses with 20 kPa: chains of large forces from its beads down to the floor.",
            contents="contacts,walls", draw="--lines contacts", lines=('{"name": "lid"', '"stages"')),
    Picture("digging", "Section: gravel in the bucket and in front of it moves; gravel below and behind is at rest.",
            contents="walls", frame=0.7, draw="--cut y 0.09 --azimuth -11 --elevation 19",
            lines=('"contacts"', '{"shape": "mesh"')),
    Picture("hopper", "Section: beads accelerate in the neck and fall freely below it; beads at the wall hardly move.",
            contents="walls", frame=0.75, draw="--cut y 0 --azimuth 11 --elevation 14", lines=('"walls"', '"outlets"')),
    Picture("hopper", "The same funnel and smaller beads: they rest in the cone until they are close to the outlet.",
            name="hopper-large", heading="A hundred thousand beads run out of a funnel", contents="walls",
            settings=("d=1.66 mm", "contact.stiffness=200", "steps.safety=0.4", "opens=0.05", "time=0.35",
                      "output.frames=10 ms"),
            draw="--cut y 0 --azimuth 11 --elevation 14", animated=True, long="8 minutes", lines=('"let"', '"particles"')),
    Picture("silo", "Fine and coarse gravel of one sieve curve runs out after half a kilogram was filled in.",
            lines=('"insertions"',)),
    Picture("gate", "The gate is gone: beads run out, and those beyond the edge have left the scene.", frame=0.3,
            lines=('"outlets"', '"stages"')),
    Picture("drum", "A thin layer flows down the slope, several times as fast as the wall; the core below hardly moves.",
            draw="--azimuth 9 --elevation 6", lines=('"periodic"', '"walls"')),
    Picture("stirrer", "Section: the beads around the stirrer, a driven clump at the bottom, go with it; others hardly move.",
            draw="--cut y 0", lines=('"particles"', '{"name": "stirrer"', '"drives"')),
    Picture("chute", "The bottom layer is held; speed grows with height, most of all near the base.",
            lines=('"gravity"', '"periodic"', '"drives"')),
    Picture("belt", "The belt has started: the lower beads go with it, the upper ones lag behind.", frame=0.2,
            lines=('"walls"', '"stages"')),
    Picture("column", "The toe spreads and a wedge at the wall stays at rest.", frame=0.55, lines=('"walls"',)),
    Picture("column", "The same column, three times as long and high and six times as wide.",
            name="column-large", heading="A hundred thousand beads collapse",
            settings=("length=64*d", "height=64*d", "width=24*d", "contact.stiffness=1000", "opens=0.05", "time=0.6",
                      "steps.safety=0.4", "output.frames=40 ms"), frame=0.8, long="6 minutes",
            lines=('"let"', '"contact"', '"particles"')),
    Picture("wet-column", "Bridges of water hold the beads together: the column stands without its gate.",
            lines=('"liquid_bridge"',)),
    Picture("wet-column", "Without water it collapses.", name="dry-column", heading="The same column, dry",
            settings=("tension=0",), lines=('"let"',)),
    Picture("column-collapse", "Material points flow over those at rest, in the light core of the heap; the base holds the lowest.",
            draw="--solids plastic_strain", lines=('"solids"',)),
    Picture("snowball", "The ball has flattened on the beads, which it throws up and ahead; its front has yielded most.",
            frame=0.3, draw="--solids plastic_strain --azimuth 20 --elevation 18", lines=('"solids"', '"couplings"')),
    Picture("pipe-in-cells", "Sand flows round the pipe and rises beside it; every point has its own cell of discs.",
            draw="--solids shear_strain", lines=('"cells"', '"solids"')),
    Picture("footing-in-cells", "A wedge goes down with the footing, a fan shears, and the ground beside it is lifted.",
            draw="--solids shear_strain", lines=('"sets"', '"planes"', '"loads"')),
    Picture("bonded-beam", "The bonds in the middle have failed in tension; both halves oscillate.",
            contents="bonds", frame=0.8, draw="--lines bonds", lines=('"bonds"',)),
    Picture("cantilever", "Two balls slide to the free end of the beam; bending stress is largest at the clamp.",
            frame=0.95, settings=("output.frames=1 s",), lines=('"particles"', '"solids"', '"couplings"')),
    Picture("wave", "The pulse is in the overlap: grains and solid move together, without visible reflection.",
            frame=0.66, draw="--solids speed", lines=('"drives"', '"couplings"')),
    Picture("static-cantilever", "Stress is largest at the top and bottom of the clamped end, and zero at the tip.",
            settings=("solids.0.cells=[40,1,8]",), draw="--azimuth 8 --elevation 12", lines=('"supports"', '"loads"', '"stages"')),
    Picture("two-materials", "The layers carry stresses of 1 to 3, their ratio of stiffness, where they meet.",
            draw="--warp 100 --azimuth 25 --elevation 12", lines=('"sets"', '"regions"')),
    Picture("shaft", "Stress is largest in the middle of the sides and small in the edges and on the axis.",
            draw="--warp 5 --size 700 900", lines=('"supports"',)),
    Picture("arch", "The half of the arch after it has snapped through: stress is that of a straight bar, nearly uniform.",
            draw="--azimuth 0 --elevation 0", lines=('"stages"',)),
    Picture("plucked", "The tip, which its support has let go, swings: 6 mm down in its second period.", frame=0.6,
            draw="--warp 5 --solids displacement", lines=('"stages"',)),
    Picture("shear-band", "The shear has gathered in a band from the weak spot on the left; its width is that of the gradient.",
            draw="--solids shear_strain --size 700 800", lines=('"gradient"', '"material"', '"supports"')),
    Picture("biaxial-cells", "Bands of shear between the plates: no law of the solid says so, the discs at its points do.",
            draw="--solids shear_strain --size 700 800", lines=('"cells"', '"material"', '"loads"')),
    Picture("biaxial-points", "The same as material points, whose faces bear the pressures and the plate: two bands that cross.",
            draw="--solids shear_strain --size 700 800", lines=('"solids"',)),
    Picture("ball-on-cells", "Section under the ball, about when it turns back: the pressure that the spheres of the cells bear.",
            frame=0.15, draw="--cut y -0.02 --solids pressure --size 900 700", lines=('"cells"', '"material"', '"couplings"')),
    Picture("frequencies", "The third mode of a cantilever, the second about its softer axis: one place along it stands still.",
            draw="--mode 3", lines=('"stages"',)),
)
