// Blocks whose points have cells of discs.
#pragma once

#include "loaded_bars.hpp"

namespace dovetail::scene::test {

/// @param keys  further keys of the cells, with a comma behind
inline std::string discs(const std::string& keys = "") {
  return R"("cells": [{"name": "sand", "grains": "discs", "count": 60, "radius": {"smallest": 3e-3, "largest": 7e-3}, )" +
         keys + R"("density": 2650, "thickness": 0.1, "contact": {"law": "linear", "modulus": 6e8, "friction": 0.5},
      "prepare": [{"pressure": 1e5, "friction": 0.2}]}],)";
}
inline const std::string sides = R"("loads": [{"on": "x+", "type": "pressure", "pressure": 1e5}])";
inline const std::string frame = R"("supports": [{"on": "x-", "components": ["x"]}, {"on": "y-", "components": ["y"]},
    {"on": "y+", "components": ["y"], "displacement": [0, "-2e-4*t", 0]}])";

/// A block of 0.1 × 0.2 m of these cells.
inline std::string block(const std::string& keys, const std::string& mesh = R"("cell": "quad4", "cells": [1, 1, 1])",
                         const std::string& material = R"({"law": "cells", "cells": "sand"})") {
  return R"("solids": [{"name": "block", "mesh": "box", "gravity": false, )" + mesh +
         R"(, "box": [[0, 0, 0], [0.1, 0.2, 0.1]], "material": )" + material + ", " + keys + "}],";
}
inline const std::string runs = R"("steps": {"safety": 0.8}, "stages": [{"do": "run", "time": 0.02}])";
inline const std::string loads = R"("steps": {"dt": 1e-4}, "stages": [{"do": "statics", "load_steps": 2, "time": 1}])";

inline Scene blockScene(const std::string& stages, const std::string& cells = discs(),
                        const std::string& keys = frame + ", " + sides) {
  return sceneFromText("{" + cells + block(keys) + stages + "}", "s.json", "/");
}
}  // namespace dovetail::scene::test
