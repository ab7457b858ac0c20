// A rank that answers for points of the fields of rank 0.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "share.hpp"

namespace dovetail::hierarchical {

class FarmWorker {
public:
  /// Does what a letter says. @return the reply, where it wants one
  std::optional<std::vector<char>> answer(std::vector<char> letter);

private:
  void act(Verb verb, ByteReader& letter, ByteWriter& reply);
  void noteFailure();

  std::map<std::uint64_t, FarmShare> fields_;
  Outcome outcome_ = Outcome::done;  ///< what went wrong since the last reply
  std::string failure_;
};

}  // namespace dovetail::hierarchical
