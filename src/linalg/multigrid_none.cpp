#include "dovetail/core/error.hpp"
#include "dovetail/linalg/multigrid.hpp"

namespace dovetail::linalg {

struct Multigrid::Impl {};

bool Multigrid::available() { return false; }
void Multigrid::require(const std::string& where) {
  throw InputError("this build has no multigrid", where,
                   "configure it with -D DOVETAIL_RANKS=ON (PETSc), or take another method");
}
Multigrid::Multigrid(double, int) { require("linear solver"); }
Multigrid::~Multigrid() = default;
Multigrid::Multigrid(Multigrid&&) noexcept = default;
void Multigrid::take(RowMatrix&, std::size_t, bool, std::span<const std::vector<double>>) {}
void Multigrid::take(SharedRows&, std::size_t, bool, std::span<const std::vector<double>>) {}
void Multigrid::solve(std::span<double>, double) {}
std::int64_t Multigrid::iterations() const { return 0; }
std::int64_t Multigrid::setUps() const { return 0; }

}  // namespace dovetail::linalg
