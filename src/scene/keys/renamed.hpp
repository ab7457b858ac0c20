// Names of scenes that have changed: the one table that messages and `dovetail upgrade` read.
#pragma once

#include <array>
#include <string_view>

namespace dovetail::scene {

struct Renamed {
  enum class Kind { key, word, column };
  Kind kind;
  std::string_view within;  ///< the list or object of the scene that holds it; of words, with the key itself
  std::string_view was, is;
  std::string_view since;  ///< version
};

inline constexpr std::array renamed = {
    Renamed{Renamed::Kind::key, "steps", "per_window", "per_macro_step", "0.1"},
    Renamed{Renamed::Kind::key, "stages", "windows", "macro_steps", "0.1"},
    Renamed{Renamed::Kind::word, "stages.do", "settle", "relax", "0.1"},
    Renamed{Renamed::Kind::key, "solids", "mass_share", "consistent_mass", "0.1"},
    Renamed{Renamed::Kind::key, "couplings", "take_over", "initial_equilibrium", "0.1"},
    Renamed{Renamed::Kind::column, "series", "brought_to_rest_J", "kinetic_damping_J", "0.1"},
    Renamed{Renamed::Kind::column, "series", "particles_lifted_by_periods_minus_J",
            "particles_gravity_work_across_periods_minus_J", "0.1"},
    Renamed{Renamed::Kind::column, "series", "loads_one_step_old_minus_what_they_made_J",
            "staggering_error_minus_what_it_made_J", "0.1"},
    Renamed{Renamed::Kind::column, "frames", "share", "solid_weight", "0.1"},
};

}  // namespace dovetail::scene
