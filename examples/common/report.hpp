// What every example prints about its run, and the files it writes.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <span>
#include <string>

#include "dovetail/cg/fields.hpp"
#include "dovetail/core/ledger.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/io/provenance.hpp"

namespace dovetail::example {

/// The energies of a model as a ledger; open() it with those at the start, then set those at the end.
class ModelLedger {
public:
  explicit ModelLedger(const dem::Energies& start);
  void set(const dem::Energies& now);
  const EnergyLedger& ledger() const { return ledger_; }
  /// |residual| over what has been lost.
  double relativeResidual() const;

private:
  EnergyLedger ledger_;
};

/// dt beside the safe step and who sets that.
void printStep(std::ostream& out, double dt, const dem::ContactStep& safe, const dem::Particles& particles);

/// Positions, radii and speeds as <folder>/<name>.csv, and as frame 0 of <name>.pvd if the build has VTK.
void writeParticles(const std::filesystem::path& folder, const std::string& name, double time,
                    const dem::Particles& particles, const io::KeyValues& provenance);

/// Reference positions X, m, and displacements u, m, of a solid's nodes as <folder>/<name>.csv.
void writeNodes(const std::filesystem::path& folder, const std::string& name, std::span<const Vec3> X,
                std::span<const Vec3> u, const io::KeyValues& provenance);

/// Continuum fields at points as <folder>/<name>.csv, one row per point. Stresses are positive in tension.
void writeFields(const std::filesystem::path& folder, const std::string& name, std::span<const Vec3> points,
                 const cg::Fields& fields, const io::KeyValues& provenance);

/// Does nothing in a build without VTK.
void writeVtu(const std::filesystem::path& folder, const std::string& name, double time,
              const dem::Particles& particles, const io::KeyValues& provenance);

}  // namespace dovetail::example
