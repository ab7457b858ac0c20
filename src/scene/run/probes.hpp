// What a scene asks for by name, as columns of the series.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dovetail/scene/build.hpp"

namespace dovetail::scene {

/// Looked up in the run at its start, before it goes on from a checkpoint.
class Probes {
public:
  /// @throws InputError with the place in the scene file of a probe of what is not there
  Probes(const Built& built, const Scene& scene);
  /// Names of columns with their units.
  const std::vector<std::string>& names() const { return names_; }
  /// Appends the values as they are now; NaN for a grain that has left.
  void add(const Built& built, std::vector<double>& row) const;

private:
  using Values = std::function<void(const Built&, std::vector<double>&)>;
  template <class Kind>
  Values find(const Built& built, const Scene& scene, const std::string& name, const Kind& kind);
  void nameVector(const std::string& name, const std::string& unit);

  std::vector<std::string> names_;
  std::vector<Values> values_;
  /// Of solids that are asked for, now.
  std::shared_ptr<std::map<std::size_t, coupling::Reactions>> reactions_ =
      std::make_shared<std::map<std::size_t, coupling::Reactions>>();
};

}  // namespace dovetail::scene
