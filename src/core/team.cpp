#include "dovetail/core/team.hpp"

#include <algorithm>
#include <utility>

#include "dovetail/core/archive.hpp"

namespace dovetail {

namespace {

std::unique_ptr<Team>& theTeam() {
  static std::unique_ptr<Team> team = std::make_unique<Team>();
  return team;
}

}  // namespace

Team& team() { return *theTeam(); }
void setTeam(std::unique_ptr<Team> team) { theTeam() = std::move(team); }

std::vector<std::vector<char>> Team::gather(std::vector<char> own) {
  std::vector<std::vector<char>> all;
  all.push_back(std::move(own));
  return all;
}

double Team::sum(double own) {
  sum(std::span(&own, 1));
  return own;
}

double Team::largest(double own) {
  ByteWriter letter;
  letter(own);
  for (std::vector<char>& arrived : gather(letter.take())) {
    ByteReader reader(std::move(arrived));
    double other = 0.0;
    reader(other);
    own = std::max(own, other);
  }
  return own;
}

void agree(Failure failure, const std::string& text) {
  ByteWriter letter;
  letter(failure, text);
  std::vector<std::vector<char>> all = team().gather(letter.take());
  for (std::size_t rank = 0; rank < all.size(); ++rank) {
    ByteReader reader(std::move(all[rank]));
    reader(failure);
    std::string said;
    reader(said);
    if (failure != Failure::none) raise(failure, said, "rank " + std::to_string(rank));
  }
}

}  // namespace dovetail
