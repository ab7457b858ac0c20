// Keys of solids of material points.
#include "keys.hpp"

namespace dovetail::scene {

void describe(Fields& f, PointBox& v) {
  f.box({"box", "that is filled; in plane strain its extent along z is the thickness"}, v.box);
}
void describe(Fields& f, PointBall& v) {
  f.vector({"centre", "of the sphere"}, v.centre, unit::length);
  f.number({"radius", "of the sphere"}, v.radius, positive(unit::length));
}
void describe(Fields& f, PointSurface& v) { f.object({"surface", "closed, whose inside is filled"}, v.surface); }
void describe(Fields& f, PointFile& v) {
  f.file({"file",
          "CSV with columns x_m, y_m, z_m and, if there, volume_m3 (in plane strain needed) and all of vx_m_per_s, "
          "vy_m_per_s, vz_m_per_s, which are added to the velocity of the solid"},
         v.file);
}
void describe(Fields& f, PointFilling& v) {
  static constexpr const char* sources[] = {"box", "cylinder", "sphere", "surface", "csv"};
  f.oneOf({"from",
           "what is filled, or a file with every point; in plane strain a box, a cylinder along z, whose length is the "
           "thickness, or a file"},
          v.from, sources);
  f.integer({"per_axis", "points along an axis of a cell of the grid: 2 are 4 a cell in plane strain, else 8"},
            v.perAxis, 1, 8);
}
void describe(Fields& f, PointBorder& v) {
  static constexpr const char* kinds[] = {"symmetry", "held"};
  f.where(v.where);
  f.word({"side", "of the body that it bounds"}, v.side, sides);
  f.number({"at", "coordinate, of nodes of the grid"}, v.at, any(unit::length));
  f.choice({"kind", "symmetry: points slide along it; held: they stick"}, v.kind, kinds);
}
void describe(Fields& f, PointGrid& v) {
  static constexpr const char* shapes[] = {"linear", "gimp", "quadratic", "cubic"};
  static constexpr const char* transfers[] = {"flip", "apic"};
  f.number({"spacing", "of its nodes"}, v.spacing, positive(unit::length));
  f.flag({"plane_strain", "points move in x and y, and lie at z = 0"}, v.plane);
  f.choice({"shape", "of the weights of nodes: B-splines, or linear ones and uGIMP to compare"}, v.shape, shapes);
  f.vector({"origin", "where a node would lie"}, v.origin, unit::length);
  f.list({"borders", "planes through nodes that the body does not pass"}, v.borders);
  f.choice(
      {"transfer",
       "of velocities when the grid is renewed: flip adds the change of those of nodes; apic takes them with their "
       "gradient and keeps angular momentum"},
      v.transfer, transfers);
  f.number({"damping", "of flip: rate at which velocities of points go over to those of nodes (PIC)"}, v.damping,
           notNegative(unit::rate));
  f.number({"renewal", "of the grid, when a node has travelled this part of the spacing"}, v.renewal,
           between(0.0, 0.5, true));
}
void describe(Fields& f, PointMesh& v) {
  f.object({"points", "of the body"}, v.points);
  f.object({"grid", "under the points"}, v.grid);
}

void describe(Fields& f, PointSpheres& v) {
  f.number({"radius", "of the spheres at the points; half the distance of points in a cell if not given"}, v.radius,
           positive(unit::length));
  contactMaterial(f, v.contactMaterial);
}

}  // namespace dovetail::scene
