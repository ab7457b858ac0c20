// dovetail convert: grains and meshes from files of one kind into another.
#include "dovetail/scene/convert.hpp"

#include <iostream>

#include "program/options.hpp"
#include "verbs.hpp"

namespace dovetail::program {

bool convertFile(int argc, char** argv) {
  std::string from, to;
  std::int64_t frame = -1;
  int units = 0;
  scene::ConvertOptions settings;
  Options options(
      "dovetail convert",
      "Grains from files of LAMMPS, LIGGGHTS, YADE and MercuryDPM, tables, frames, states and runs into data "
      "files of LAMMPS, tables and frames; meshes of solids, Exodus among them, into others.");
  options.text("IN", from, "a file, or the folder of a run").require();
  options
      .text("OUT", to,
            "grains: .data or .lmp (LAMMPS), .csv, .vtu, .vtkhdf (all frames of a run); meshes: .msh, .inp, .vtu")
      .require();
  options.number("--density D", settings.density, positive(), "of grains, kg/m³, where IN has none");
  options.choice("--units", units, "file|si|cgs|micro|nano|lj",
                 "of files of LAMMPS; file: those it names, else si; lj: taken as m, kg and s");
  options.number("--frame N", frame, between(-1e9, 1e9), "of several, from 0; -1 is the last");
  if (!options.parse(argc, argv)) return true;
  settings.units = static_cast<grain_io::Units>(units);
  if (options.given("--frame")) settings.frame = frame;
  scene::convert(from, to, settings, std::cout);
  return true;
}

}  // namespace dovetail::program
