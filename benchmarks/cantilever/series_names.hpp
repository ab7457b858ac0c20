// Columns of a run's time series.
#pragma once

#include <string>
#include <vector>

namespace dovetail::cantilever {

inline const std::vector<std::string> seriesNames{"time_s",
                                                  "x1_m",
                                                  "y1_m",
                                                  "z1_m",
                                                  "vx1_m_per_s",
                                                  "vy1_m_per_s",
                                                  "vz1_m_per_s",
                                                  "x2_m",
                                                  "y2_m",
                                                  "z2_m",
                                                  "vx2_m_per_s",
                                                  "vy2_m_per_s",
                                                  "vz2_m_per_s",
                                                  "mass_particles_kg",
                                                  "mass_beam_kg",
                                                  "momentum_particles_x_Ns",
                                                  "momentum_particles_y_Ns",
                                                  "momentum_particles_z_Ns",
                                                  "momentum_beam_x_Ns",
                                                  "momentum_beam_y_Ns",
                                                  "momentum_beam_z_Ns",
                                                  "kinetic_particles_J",
                                                  "elastic_contacts_J",
                                                  "gravity_particles_J",
                                                  "kinetic_beam_J",
                                                  "elastic_beam_J",
                                                  "energy_total_J",
                                                  "dashpots_J",
                                                  "made_by_coupling_J",
                                                  "ledger_residual_J",
                                                  "tip_dx_m",
                                                  "tip_dy_m",
                                                  "tip_dz_m"};

}  // namespace dovetail::cantilever
