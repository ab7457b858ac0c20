#include "dovetail/ranks/team_of_ranks.hpp"

#include <mpi.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "companions.hpp"
#include "dovetail/core/lost_error.hpp"
#include "dovetail/core/team.hpp"
#include "dovetail/ranks/session.hpp"

namespace dovetail::ranks {

namespace {

constexpr const char* doing = "sharing between ranks";

/// Sizes and places of letters that lie one after the other.
struct Layout {
  std::vector<int> size, first;
  std::size_t all = 0;

  explicit Layout(std::vector<int> sizes) : size(std::move(sizes)), first(size.size(), 0) {
    for (std::size_t k = 0; k < size.size(); all += static_cast<std::size_t>(size[k]), ++k) {
      if (all > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw LostError("what a rank has for the others is 2 GiB or more", "ranks", "take more ranks");
      first[k] = static_cast<int>(all);
    }
  }
  std::vector<std::vector<char>> cut(const std::vector<char>& bytes) const {
    std::vector<std::vector<char>> letters;
    for (std::size_t k = 0; k < size.size(); ++k)
      letters.emplace_back(bytes.begin() + first[k], bytes.begin() + first[k] + size[k]);
    return letters;
  }
};

class RankTeam final : public Team {
public:
  int rank() const override { return rank_; }
  int size() const override { return size_; }

  /// On the first rank, which tells the others.
  void sum(std::span<double> values) override {
    constexpr std::size_t most = 1 << 27;
    for (; values.size() > most; values = values.subspan(most)) sumOf(values.first(most));
    sumOf(values);
  }
  /// In pieces: MPI counts bytes by int.
  std::vector<std::vector<char>> gather(std::vector<char> own) override {
    const std::vector<std::size_t> sizes = sizesOf(own.size());
    const std::size_t piece = (std::size_t{1} << 30) / sizes.size();
    std::vector<std::vector<char>> letters(sizes.size());
    for (std::size_t first = 0; first < std::ranges::max(sizes); first += piece) {
      std::vector<int> now;
      for (const std::size_t size : sizes)
        now.push_back(static_cast<int>(std::min(piece, size - std::min(first, size))));
      const Layout layout(std::move(now));
      const std::vector<std::vector<char>> parts =
          layout.cut(gatherAs(layout, std::span(own).subspan(std::min(first, own.size()))));
      for (std::size_t rank = 0; rank < parts.size(); ++rank)
        letters[rank].insert(letters[rank].end(), parts[rank].begin(), parts[rank].end());
    }
    return letters;
  }
  std::vector<std::vector<char>> exchange(std::vector<std::vector<char>> letters) override {
    std::vector<int> sizes, arriving(letters.size());
    std::vector<char> out;
    for (const std::vector<char>& letter : letters) {
      sizes.push_back(static_cast<int>(letter.size()));
      out.insert(out.end(), letter.begin(), letter.end());
    }
    const Layout going(std::move(sizes));
    MPI_Request request = MPI_REQUEST_NULL;
    require(MPI_Ialltoall(going.size.data(), 1, MPI_INT, arriving.data(), 1, MPI_INT, ownCommunicator(), &request),
            doing);
    companions().wait(request, doing);
    const Layout coming(std::move(arriving));
    std::vector<char> in(coming.all);
    require(MPI_Ialltoallv(out.data(), going.size.data(), going.first.data(), MPI_BYTE, in.data(), coming.size.data(),
                           coming.first.data(), MPI_BYTE, ownCommunicator(), &request),
            doing);
    companions().wait(request, doing);
    return coming.cut(in);
  }

private:
  void sumOf(std::span<double> values) {
    MPI_Request request = MPI_REQUEST_NULL;
    const int count = static_cast<int>(values.size());
    const void* const own = rank_ == 0 ? MPI_IN_PLACE : values.data();
    require(MPI_Ireduce(own, values.data(), count, MPI_DOUBLE, MPI_SUM, 0, ownCommunicator(), &request), doing);
    companions().wait(request, doing);
    require(MPI_Ibcast(values.data(), count, MPI_DOUBLE, 0, ownCommunicator(), &request), doing);
    companions().wait(request, doing);
  }
  std::vector<std::size_t> sizesOf(std::size_t own) const {
    std::vector<std::size_t> all(static_cast<std::size_t>(size_));
    MPI_Request request = MPI_REQUEST_NULL;
    require(MPI_Iallgather(&own, sizeof own, MPI_BYTE, all.data(), sizeof own, MPI_BYTE, ownCommunicator(), &request),
            doing);
    companions().wait(request, doing);
    return all;
  }
  std::vector<char> gatherAs(const Layout& layout, std::span<const char> own) const {
    std::vector<char> all(layout.all);
    MPI_Request request = MPI_REQUEST_NULL;
    require(MPI_Iallgatherv(own.data(), layout.size[static_cast<std::size_t>(rank_)], MPI_BYTE, all.data(),
                            layout.size.data(), layout.first.data(), MPI_BYTE, ownCommunicator(), &request),
            doing);
    companions().wait(request, doing);
    return all;
  }

  int rank_ = ranks::rank(), size_ = ranks::count();
};

}  // namespace

void formTeam() {
  start();
  if (count() == 1) return;
  companions();
  setTeam(std::make_unique<RankTeam>());
}

}  // namespace dovetail::ranks
