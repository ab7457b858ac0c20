#include "common/report.hpp"

#include <cmath>
#include <ostream>

#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::example {

namespace {
enum Channel : EnergyLedger::Id { kinetic, gravity, contacts, dashpots, sliding, rolling, escaped, walls };
}

ModelLedger::ModelLedger(const dem::Energies& start) {
  for (const char* name : {"kinetic", "gravity", "contacts"}) ledger_.addStored(name);
  for (const char* name : {"dashpots", "sliding", "rolling resistance", "left the scene", "work on moving walls"})
    ledger_.addBooked(name);
  set(start);
  ledger_.open();
}

void ModelLedger::set(const dem::Energies& now) {
  ledger_.set(kinetic, now.kinetic);
  ledger_.set(gravity, now.gravity);
  ledger_.set(contacts, now.contacts);
  ledger_.set(dashpots, now.lost.dissipatedPower);
  ledger_.set(sliding, now.lost.frictionPower);
  ledger_.set(rolling, now.lost.rollingPower);
  ledger_.set(escaped, now.left - now.entered);
  ledger_.set(walls, -now.walls);
}

double ModelLedger::relativeResidual() const {
  double lost = 0.0;
  for (const auto id : {dashpots, sliding, rolling})
    lost += ledger_.channels()[id].joules - ledger_.channels()[id].joulesAtOpening;
  return std::abs(ledger_.residual()) / lost;
}

void printStep(std::ostream& out, double dt, const dem::ContactStep& safe, const dem::Particles& particles) {
  out << "step " << dt << " s, " << dt / safe.dt << " of the safe one, " << safe.dt << " s";
  if (safe.particle >= 0) {
    const auto name = [&](int i) {
      const auto k = static_cast<std::size_t>(i);
      return std::to_string(particles.id.empty() ? static_cast<std::int64_t>(i) : particles.id[k]);
    };
    out << ", set by particle " << name(safe.particle) << " and "
        << (safe.partner < 0 ? "a wall" : "particle " + name(safe.partner));
  }
  out << '\n';
}

void writeParticles(const std::filesystem::path& folder, const std::string& name, double time,
                    const dem::Particles& particles, const io::KeyValues& provenance) {
  io::prepareOutputFolder(folder, {name + ".csv"});
  io::TimeSeries table({"x_m", "y_m", "z_m", "radius_m", "speed_m_per_s"});
  for (std::size_t i = 0; i < particles.size(); ++i)
    table.append({particles.x[i].x, particles.x[i].y, particles.x[i].z, particles.radius[i], norm(particles.v[i])});
  io::writeCsv(folder / (name + ".csv"), table, provenance);
  writeVtu(folder, name, time, particles, provenance);
}

void writeNodes(const std::filesystem::path& folder, const std::string& name, std::span<const Vec3> X,
                std::span<const Vec3> u, const io::KeyValues& provenance) {
  io::prepareOutputFolder(folder, {name + ".csv"});
  io::TimeSeries table({"X_m", "Y_m", "Z_m", "ux_m", "uy_m", "uz_m"});
  for (std::size_t n = 0; n < X.size(); ++n) table.append({X[n].x, X[n].y, X[n].z, u[n].x, u[n].y, u[n].z});
  io::writeCsv(folder / (name + ".csv"), table, provenance);
}

void writeFields(const std::filesystem::path& folder, const std::string& name, std::span<const Vec3> points,
                 const cg::Fields& fields, const io::KeyValues& provenance) {
  io::prepareOutputFolder(folder, {name + ".csv"});
  io::TimeSeries table({"x_m", "y_m", "z_m", "density_kg_per_m3", "solid_fraction", "vx_m_per_s", "vy_m_per_s",
                        "vz_m_per_s", "temperature_m2_per_s2", "stress_xx_Pa", "stress_yy_Pa", "stress_zz_Pa",
                        "stress_yz_Pa", "stress_zx_Pa", "stress_xy_Pa"});
  for (std::size_t p = 0; p < fields.size(); ++p) {
    const Vec3 &x = points[p], &v = fields.velocity[p];
    const Eigen::Matrix3d s = fields.stress(p);
    table.append({x.x, x.y, x.z, fields.density[p], fields.solidFraction[p], v.x, v.y, v.z, fields.temperature[p],
                  s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(2, 0), s(0, 1)});
  }
  io::writeCsv(folder / (name + ".csv"), table, provenance);
}

}  // namespace dovetail::example
