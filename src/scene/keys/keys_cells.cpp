// Keys of cells of grains.
#include "keys.hpp"

namespace dovetail::scene {

void describe(Fields& f, CellLinearContact& v) {
  f.number({"modulus", "E of the normal springs, whose stiffness is 2 E r1 r2/(r1 + r2); this or a stiffness"},
           v.modulus, positive(unit::pressure));
  f.number({"stiffness", "of all normal springs"}, v.stiffness, positive(unit::stiffness));
  f.number({"stiffness_ratio", "tangential over normal stiffness"}, v.stiffnessRatio, notNegative(unit::none));
  f.number({"rolling", "rolling over tangential stiffness and the product of the radii; discs"}, v.rolling,
           notNegative(unit::none));
  f.number({"rolling_friction", "largest moment over (smaller radius × normal force); discs"}, v.rollingFriction,
           notNegative(unit::none));
}
void describe(Fields& f, CellHertzContact& v) {
  young(f, v.youngsModulus);
  poisson(f, v.poissonRatio);
}
void describe(Fields& f, CellContact& v) {
  static constexpr const char* laws[] = {"linear", "Hertz"};
  f.where(v.where);
  f.oneOf({"law", "normal force: a linear spring, or Hertz's with Mindlin's tangential stiffness (spheres)"}, v.law,
          laws);
  f.number({"friction", "Coulomb's coefficient"}, v.friction, notNegative(unit::none));
}
void describe(Fields& f, CellPressing& v) {
  f.where(v.where);
  f.number({"pressure", "on all sides, > 0 in compression"}, v.pressure, positive(unit::pressure));
  f.number({"friction", "of the contacts until the pressure is there; their own if not given"}, v.friction,
           notNegative(unit::none));
}

namespace {

void preparation(Fields& f, CellPreparation& v) {
  f.object({"contact", "law of the contacts"}, v.contact);
  f.list({"prepare", "pressures one after the other; the last is the initial stress of the solid"}, v.prepare, true);
  f.number({"tolerance", "of the pressures, relative"}, v.tolerance, between(0.0, 0.1, true));
  f.integer({"number", "of different cells, dealt to the points of a solid in turn"}, v.number, 1, 100000);
}
void random(Fields& f, RandomCells& v) {
  f.integer({"count", "of grains in each cell; below 100 they are too few to be representative"}, v.count, 4, 1000000);
  f.object({"radius", "of the grains"}, v.radius);
  density(f, v.density);
  preparation(f, v);
  f.integer({"seed", "of the first cell; the same seed gives the same cell"}, v.seed, 0, anySeed);
}

}  // namespace

void describe(Fields& f, DiscCells& v) {
  random(f, v);
  f.number({"thickness", "length of the discs"}, v.thickness, positive(unit::length));
}
void describe(Fields& f, SphereCells& v) { random(f, v); }
void describe(Fields& f, CutCells& v) {
  f.file({"file",
          "with the packing: whatever dovetail convert reads grains from, such as the checkpoint.state of a run, "
          "a frame or a table"},
         v.file);
  f.box({"box", "of the first cell: spheres with their centres in it become a cell that repeats"}, v.box);
  f.vector({"step", "from the box of each cell to that of the next, where there are several"}, v.step, unit::length);
  f.number({"density", "mass per volume of the grains, where the file has none"}, v.density, positive(unit::density));
  preparation(f, v);
}
void describe(Fields& f, CellFile& v) {
  f.file({"file", "cells that dovetail cell or rve::writeSamples has written"}, v.file);
}
void describe(Fields& f, Cells& v) {
  static constexpr const char* kinds[] = {"discs", "spheres", "cut", "file"};
  f.where(v.where);
  f.text({"name", "for materials of solids"}, v.name, true);
  f.oneOf({"grains",
           "discs, for plane strain (quad4, quad8), or spheres, at random places in a periodic cell, relaxed and "
           "pressed; cut: the same of spheres of a packing; or cells from a file"},
          v.grains, kinds);
}

}  // namespace dovetail::scene
