// The keys of what is written.
#include "fields.hpp"

namespace dovetail::scene {

namespace {
void solid(Fields& f, std::string& value) { f.text({"solid", "name of the solid"}, value, true); }
}  // namespace

void describe(Fields& f, GrainProbe& v) {
  f.vector({"at", "position; the probe follows the grain nearest to it at the start"}, v.at, unit::length);
}
void describe(Fields& f, NodeProbe& v) {
  solid(f, v.solid);
  f.vector({"at", "position; the probe follows the node, or material point, nearest to it at the start"}, v.at,
           unit::length);
}
void describe(Fields& f, BodyProbe& v) { solid(f, v.solid); }
void describe(Fields& f, WallProbe& v) {
  f.nameOrNumber({"wall", "its name, or which item of \"walls\", counted from 0"}, v.wall);
}
void describe(Fields& f, SolidProbe& v) {
  solid(f, v.solid);
  f.text({"on", "face set of its surface couplings; all of them if not given"}, v.on, false);
  f.vector({"point", "that moments are about; the origin if not given"}, v.point, unit::length);
}
void describe(Fields& f, DriveProbe& v) {
  f.integer({"drive", "which item of \"drives\", counted from 0"}, v.drive, 0, 1000000);
}
void describe(Fields& f, SupportProbe& v) {
  solid(f, v.solid);
  f.text({"on", "node set with supports, whose forces are summed; if it has ties only, theirs"}, v.on, true);
}
void describe(Fields& f, CellsProbe& v) {
  solid(f, v.solid);
  f.vector({"at", "position; the cell nearest to it at the start; the mean of all if not given"}, v.at, unit::length);
}
void describe(Fields& f, PlaneProbe& v) {
  solid(f, v.solid);
  f.integer({"plane", "which item of the solid's \"planes\", counted from 0"}, v.plane, 0, 1000000);
}
void describe(Fields& f, RegionProbe& v) {
  f.box({"box", "two corners"}, v.box);
  f.text({"solid",
          "in place of the grains: name of a solid, whose mean velocity is that of its part in the region at the "
          "start, by volume, or of its material points, by mass"},
         v.solid, false);
}
void describe(Fields& f, Probe& v) {
  static constexpr const char* kinds[] = {"grain", "node",    "body",   "wall",  "solid",
                                          "drive", "support", "region", "cells", "plane"};
  f.where(v.where);
  f.text({"name", "of its columns: letters, digits, '_', '-' and '.', with a letter first"}, v.name, true);
  f.oneOf({"of",
           "position and velocity of a grain, displacement of a node, centre of mass, velocity and extent of a solid, "
           "force and moment of the grains on a wall and its "
           "displacement, force and moment of the grains on a solid, force and moment of a drive on its grains or of a "
           "support on its solid, number and mean velocity of the grains in a region, or the latter of a solid, "
           "pressure, stress ratio, void "
           "ratio, contacts per grain and fraction of sliding contacts of the cells of a solid, or force of a plane on "
           "its solid and how deep that is in it"},
          v.of, kinds);
}
void describe(Fields& f, ShownCell& v) {
  f.where(v.where);
  f.text({"name", "of its files: letters, digits, '_', '-' and '.', with a letter first"}, v.name, true);
  solid(f, v.solid);
  f.vector({"at", "position; the cell nearest to it at the start"}, v.at, unit::length);
}
void describe(Fields& f, Output& v) {
  static constexpr const char* contents[] = {"grains", "spin",   "forces", "weights", "contacts", "bonds", "solids",
                                             "points", "stress", "strain", "cells",   "history",  "walls"};
  f.where(v.where);
  f.number({"series", "interval of rows of energies and momenta"}, v.series, positive(unit::time));
  f.list({"probes", "further columns of the series"}, v.probes);
  f.flag({"hdf5", "whether the series is written as series.h5 too, and solids at the end as .vtkhdf"}, v.hdf5);
  f.number({"frames", "interval of frames for ParaView"}, v.frames, positive(unit::time));
  f.wordList({"contents", "of the frames"}, v.contents, contents, false);
  f.list({"cells", "cells of grains whose grains are written with every frame, and contacts if they are in contents"},
         v.cells);
  f.number({"checkpoints", "interval of checkpoints"}, v.checkpoints, positive(unit::time));
}

}  // namespace dovetail::scene
