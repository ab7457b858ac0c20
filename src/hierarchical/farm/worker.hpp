// A rank that answers for points of the fields of rank 0.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dovetail/core/failure.hpp"
#include "share.hpp"

namespace dovetail::hierarchical {

class FarmWorker {
public:
  /// Does what a letter says. @return the reply, where it wants one
  std::optional<std::vector<char>> answer(std::vector<char> letter);

private:
  /// A field whose points are not what rank 0 takes them for, since a letter that wants no reply could not be done, has
  /// that for an answer until it is opened or cleared.
  struct Field {
    std::optional<FarmShare> share;
    Failure failure = Failure::none;
    std::string text;
  };

  std::map<std::uint64_t, Field> fields_;
};

}  // namespace dovetail::hierarchical
