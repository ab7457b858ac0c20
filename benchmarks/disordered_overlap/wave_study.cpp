#include "wave_study.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>

#include "dovetail/core/archive.hpp"
#include "dovetail/report/study.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::disordered_overlap {

namespace {

using report::format;
using report::Json;

struct Speeds {
  double axial, shear;  // m/s, a little below those of the packings
};
constexpr Speeds pressedWithout{75.0, 50.0}, pressedWith{55.0, 31.0};
constexpr const char* kindOfFile = "bed waveforms";

struct Kind {
  const char* name;
  bool shear;
};
constexpr Kind kinds[] = {{"P", false}, {"S", true}};

WaveOptions settingsOf(const WaveStudy& study, const Kind& kind) {
  WaveOptions s;
  s.shear = kind.shear;
  const Speeds& speeds = study.friction ? pressedWith : pressedWithout;
  s.speed = kind.shear ? speeds.shear : speeds.axial;
  s.strain = study.strain;
  s.weight = study.weight;
  return s;
}

std::filesystem::path fileOf(const WaveStudy& study, int packing, const Kind& kind) {
  return study.folder / format("wave-%02d-%s.bin", packing, kind.name);
}

template <class Archive>
void archiveForm(Archive& archive, auto& form) {
  std::size_t times = form.velocity.size();
  archive(form.depth, form.mass, form.time, times);
  if constexpr (Archive::reads) form.velocity.resize(times);
  for (auto& v : form.velocity) archive(v);
}

/// Full, then joined.
void keep(const WavePair& pair, const std::filesystem::path& file) {
  ByteWriter writer;
  archiveForm(writer, pair.full.form);
  archiveForm(writer, pair.joined.form);
  writeChecked(file, kindOfFile, writer.bytes());
}
std::array<Waveform, 2> kept(const std::filesystem::path& file) {
  ByteReader reader(readChecked(file, kindOfFile));
  std::array<Waveform, 2> forms;
  for (Waveform& form : forms) archiveForm(reader, form);
  return forms;
}

void addFigures(Json& figures, const std::string& name, const WaveOptions& s, const WavePair& pair) {
  const Reflected back = reflected(pair);
  const double pulse = pair.full.pulse;
  figures[name + "_dt_s"] = pair.full.dt;
  figures[name + "_pulse_J"] = pulse;
  figures[name + "_residual_full"] = pair.full.residual / pulse;
  figures[name + "_residual_joined"] = pair.joined.residual / pulse;
  figures[name + "_friction_full"] = pair.full.friction / pulse;
  figures[name + "_friction_joined"] = pair.joined.friction / pulse;
  figures[name + "_overlap_lost"] = pair.joined.overlap / pulse;
  figures[name + "_reflected_by_grain"] = back.byGrain;
  figures[name + "_reflected_by_slab"] = back.bySlab;
  figures[name + "_misfit"] = misfit(pair.joined.form, pair.full.form, s.alone());
  figures[name + "_seconds_full"] = pair.full.seconds;
  figures[name + "_seconds_joined"] = pair.joined.seconds;
}

Json runPacking(const WaveStudy& study, int number) {
  const auto begin = std::chrono::steady_clock::now();
  const double height = 1.04 * settingsOf(study, kinds[0]).depth();
  const ColumnSize size{.width = study.width, .height = height, .seed = static_cast<std::uint64_t>(number)};
  const dem::Model packing = (study.friction ? columnPressedWithFriction : pressedColumn)(size, WaveOptions{}.pressure);
  const Moduli moduli = probe(packing);
  Json figures{{"particles", packing.particles.size()},
               {"pressure_Pa", moduli.pressure},
               {"density", moduli.density},
               {"axial_Pa", moduli.axial},
               {"shear_Pa", moduli.shear}};
  for (const Kind& kind : kinds) {
    const WaveOptions settings = settingsOf(study, kind);
    const WavePair pair = runPair(packing, settings, moduli);
    addFigures(figures, kind.name, settings, pair);
    keep(pair, fileOf(study, number, kind));
  }
  figures["wall_seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  figures["finished"] = figures["stable"] = true;
  return figures;
}

/// Of the waveforms with the numbers that are given, all in grains (0) or joined (1).
Waveform meanOf(const std::vector<std::array<Waveform, 2>>& all, std::size_t which, std::size_t first,
                std::size_t step) {
  std::vector<const Waveform*> forms;
  for (std::size_t k = first; k < all.size(); k += step) forms.push_back(&all[k][which]);
  return mean(forms);
}

void printEnsemble(const WaveStudy& study, const Kind& kind) {
  std::vector<std::array<Waveform, 2>> all;
  for (int k = 1; k <= study.packings; ++k) all.push_back(kept(fileOf(study, k, kind)));
  const double depth = settingsOf(study, kind).alone();
  const double joined = misfit(meanOf(all, 1, 0, 1), meanOf(all, 0, 0, 1), depth);
  std::cout << format("%s: misfit of the mean of %d packings %.2f %%", kind.name, study.packings, 100.0 * joined);
  if (study.packings > 1) {
    const double halves = misfit(meanOf(all, 0, 0, 2), meanOf(all, 0, 1, 2), depth);
    std::cout << format(", of the halves of all-grain runs %.2f %%; target: at most %.2f %%", 100.0 * halves,
                        std::max(5.0, 150.0 * halves));
  }
  std::cout << '\n';
}

}  // namespace

bool runWaveStudy(const WaveStudy& study) {
  report::Study runs;
  runs.program = "bed";
  runs.name = "wave";
  runs.folder = study.folder;
  runs.workers = study.workers > 1 ? study.workers : 0;
  runs.shown = {"P_residual_joined", "P_reflected_by_grain", "P_misfit",
                "S_residual_joined", "S_reflected_by_grain", "S_misfit"};
  for (int k = 1; k <= study.packings; ++k)
    runs.cases.push_back({format("packing %d", k), {}, [study, k] { return runPacking(study, k); }});
  if (!report::runStudy(runs, std::cout, std::cerr)) return false;
  for (const Kind& kind : kinds) printEnsemble(study, kind);
  return true;
}

}  // namespace dovetail::disordered_overlap
