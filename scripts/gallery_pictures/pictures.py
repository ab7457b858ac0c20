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
    heading: str = ""  # the scene's title if not given

    @property
    def file(self):
        return self.name or self.scene


PICTURES = (
    Picture("plate", "The plate bends under the layer; stress is largest at the clamp, and beads at the rim move up.",
            frame=0.45, draw="--azimuth -19 --elevation 25"),
    Picture("tray", "The rubber sags under the weight; stress is largest along the two clamped sides."),
    Picture("pile", "Plastic strain of the clay: the dents of the first impacts remain.",
            contents="solids,stress,history", draw="--solids plastic_strain --elevation 32"),
    Picture("footing", "Section: grain weights fall from 1 to 0 through the overlap; soil weights rise from 0 to 1.",
            contents="solids,stress,weights", draw="--grains weight --solids solid_weight --cut y 0.115"),
    Picture("footing", "Force chains carry the load of the plate down to the overlap; in the soil it is stress.",
            contents="contacts,solids,stress", draw="--lines contacts --uncut",
            name="footing-forces", heading="Force chains under the plate"),
    Picture("digging", "Section: gravel in the bucket and in front of it moves; gravel below and behind is at rest.",
            contents="walls", frame=0.7, draw="--cut y 0.09 --azimuth -11 --elevation 19"),
    Picture("hopper", "Section: beads accelerate in the neck and fall freely below it; beads at the wall hardly move.",
            contents="walls", frame=0.75, draw="--cut y 0 --azimuth 11 --elevation 14", animated=True),
    Picture("drum", "A thin layer flows down the slope, several times as fast as the wall; the core below hardly moves.",
            draw="--azimuth 9 --elevation 6"),
    Picture("chute", "The bottom layer is held; speed grows with height, most of all near the base."),
    Picture("column", "The toe spreads and a wedge at the wall stays at rest.", frame=0.55),
    Picture("bonded-beam", "The bonds in the middle have failed in tension; both halves oscillate.",
            contents="bonds", frame=0.8, draw="--lines bonds"),
    Picture("cantilever", "Two balls slide to the free end of the beam; bending stress is largest at the clamp.",
            frame=0.95, settings=("output.frames=1 s",)),
    Picture("wave", "The pulse is in the overlap: grains and solid move together, without visible reflection.",
            frame=0.66, draw="--solids speed"),
)
