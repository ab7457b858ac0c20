"""What the gallery shows: which scene, which instant, seen from where, and what to look at."""

import math
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Picture:
    scene: str
    look: str  # what to look at, Markdown
    frame: float = 1.0  # which of the frames, as a fraction of the run
    settings: tuple = ()  # --set of the run
    contents: str = ""  # of the frames, where the scene's own are not what is drawn
    direction: tuple = (0.4, -1.0, 0.45)  # from the scene to the camera
    up: tuple = (0, 0, 1)
    zoom: float = 1.0
    grains: str = "speed"  # or "weight"
    grain_opacity: float = 1.0
    solids: dict = field(default_factory=dict)  # field of each solid; von_mises if not given
    warp: float = 1.0  # displacements are drawn so many times as large
    lines: str = ""  # "contacts" or "bonds": tubes, coloured by the normal force
    line_radius: tuple = (0.0, 0.0)  # of tubes without and with the largest force, m
    solid_opacity: float = 1.0
    wall_opacity: float = 0.25  # of walls from files
    wall_top: float = math.inf  # walls from files end there, m
    cut: tuple = ()  # (axis, place for grains and walls, place for solids): what lies before is not drawn
    range: dict = field(default_factory=dict)  # of colours, by field; that of the frame if not given
    animated: bool = False
    name: str = ""
    heading: str = ""  # the scene's title if not given

    @property
    def file(self):
        return self.name or self.scene


PICTURES = (
    Picture("plate", "The plate bends under the layer; stress is largest at the clamp, and beads at the rim move up.",
            frame=0.45, direction=(-0.35, -1.0, 0.5)),
    Picture("tray", "The rubber sags under the weight; stress is largest along the two clamped sides.",
            direction=(0.45, -1.0, 0.55)),
    Picture("pile", "Plastic strain of the clay: the dents of the first impacts remain.",
            contents="solids,stress,history", solids={"clay": "plastic_strain"}, direction=(0.5, -1.0, 0.7)),
    Picture("footing", "Section: grain weights fall from 1 to 0 through the overlap; soil weights rise from 0 to 1.",
            contents="solids,stress,weights", grains="weight", solids={"soil": "solid_weight", "plate": "von_mises"},
            cut=("y", 0.105, 0.12), direction=(0.35, -1.0, 0.3), zoom=1.1),
    Picture("footing", "Force chains carry the load of the plate down to the overlap; in the soil it is stress.",
            contents="contacts,solids,stress", grain_opacity=0.12, lines="contacts", line_radius=(0.0002, 0.004),
            direction=(0.35, -1.0, 0.3), name="footing-forces", heading="Force chains under the plate"),
    Picture("digging", "Section: gravel in the bucket and in front of it moves; gravel below and behind is at rest.",
            contents="walls", frame=0.7, direction=(-0.2, -1.0, 0.35), cut=("y", 0.09, 0.0), wall_opacity=0.8),
    Picture("hopper", "Section: beads accelerate in the neck and fall freely below it; beads at the wall hardly move.",
            contents="walls", frame=0.75, cut=("y", 0.0, 0.0), wall_top=0.13, direction=(0.2, -1.0, 0.25), animated=True),
    Picture("drum", "A thin layer flows down the slope, several times as fast as the wall; the core below hardly moves.",
            direction=(0.15, -1.0, 0.1), zoom=0.93),
    Picture("chute", "The bottom layer is held; speed grows with height, most of all near the base.",
            direction=(0.35, -1.0, 0.25)),
    Picture("column", "The toe spreads and a wedge at the wall stays at rest.",
            frame=0.55, direction=(0.25, -1.0, 0.35)),
    Picture("bonded-beam", "The bonds in the middle have failed in tension; both halves oscillate.",
            contents="bonds", frame=0.8, grain_opacity=0.25, lines="bonds", line_radius=(0.0006, 0.0025),
            direction=(0.2, -1.0, 0.3)),
    Picture("cantilever", "Two balls slide to the free end of the beam; bending stress is largest at the clamp.",
            frame=0.95, settings=("output.frames=1 s",), direction=(1.0, -0.5, 0.35)),
    Picture("wave", "The pulse is in the overlap: grains and solid move together, without visible reflection.",
            frame=0.66, direction=(1.0, -0.25, 0.5), solids={"bar": "speed"}, solid_opacity=0.45),
)
