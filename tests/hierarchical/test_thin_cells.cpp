// Cells that become long and thin are repeated.
#include <gtest/gtest.h>

#include "../threads.hpp"
#include "solids_of_cells.hpp"

namespace dovetail::hierarchical {
namespace {

using rve::plane;

constexpr int steps = 80;  // to five times the length

Eigen::Matrix3d pulled(int step) {
  const double stretch = std::exp(0.02 * step);
  return plane(1.0 / stretch, 0.2 * step / steps, 0.0, stretch);
}

Asked threePoints() { return Asked(cellField(threeCells(), DynamicCells{.strainPerStep = 2e-4}), 3); }

void pull(Asked& asked, int from, int to, bool inPlace = true) {
  for (int k = from + 1; k <= to; ++k) {
    asked(pulled(k), false, 1.0, inPlace);
    for (const std::string& reason : asked.reason) ASSERT_EQ(reason, "") << k;
    asked.field().commit();
  }
}

ByteWriter bytesOf(Asked& asked) {
  ByteWriter archive;
  asked.field().save(archive);
  return archive;
}

TEST(ThinCells, AreRepeatedWithTheSameStressAndEnergy) {
  Asked asked = threePoints();
  int copies = 1;
  for (int k = 1; k <= steps; ++k) {
    pull(asked, k - 1, k, k % 2 == 0);
    const int now = copiesAt(asked.field(), 0);
    if (now == copies) continue;
    EXPECT_EQ(now, 2 * copies) << k;
    copies = now;
    const std::vector<double> P = asked.P, energy = asked.energy;
    asked(pulled(k), false, 0.0);  // from what is committed
    const double size = matrixAt(P, 0).norm();
    EXPECT_LT((matrixAt(asked.P, 0) - matrixAt(P, 0)).norm(), 1e-13 * size) << k;
    EXPECT_NEAR(asked.energy[0], energy[0], 1e-12 * energy[0]) << k;
    EXPECT_LT(std::abs(asked.dissipated[0]), 1e-12 * energy[0]) << k;
    asked.field().revert();
  }
  EXPECT_EQ(copies, 4);
}

/// Of each of the copies what was not accounted for in the sample, to the order of the path.
TEST(ThinCells, KeepTheirBooks) {
  Asked asked = threePoints();
  const auto unaccounted = [&] {
    double sum = 0.0, work = 0.0;
    visitCell(asked.field(), 0, [&](const rve::Rve& cell) {
      const rve::RveLedger& ledger = cell.state.ledger;
      sum = ledger.work - rve::storedEnergy(cell) - rve::kineticEnergy(cell) - ledger.friction - ledger.damping;
      work = ledger.work;
    });
    return std::pair(sum / copiesAt(asked.field(), 0), work / copiesAt(asked.field(), 0));
  };
  const auto [begun, before] = unaccounted();
  pull(asked, 0, steps);
  const auto [ended, after] = unaccounted();
  EXPECT_GT(copiesAt(asked.field(), 0), 1);
  EXPECT_LT(std::abs(ended - begun), 2e-3 * (after - before));
}

TEST(ThinCells, GoOnFromBytesOnAnyNumberOfThreads) {
  Asked asked = threePoints();
  pull(asked, 0, 20);
  const ByteWriter whole = bytesOf(asked);
  EXPECT_EQ(copiesAt(asked.field(), 0), 1);
  pull(asked, 20, 60);
  const ByteWriter thin = bytesOf(asked);
  EXPECT_EQ(copiesAt(asked.field(), 0), 2);
  pull(asked, 60, steps);
  const std::vector<double> P = asked.P;
  for (const ByteWriter* archive : {&whole, &thin}) {  // into a cell of more copies, and of fewer
    Asked fresh = threePoints();
    for (Asked* other : {&asked, &fresh}) {
      ByteReader back(archive->bytes());
      other->field().load(back);
      EXPECT_TRUE(back.atEnd());
      onThreads(3, [&] {
        pull(*other, archive == &whole ? 20 : 60, steps);
        return 0;
      });
      EXPECT_EQ(other->P, P);
      EXPECT_EQ(copiesAt(other->field(), 0), 4);
    }
  }
}

/// Sheared cells have short periods again, whatever the shear.
TEST(ThinCells, AreNotThoseThatAreSheared) {
  Asked asked = threePoints();
  for (int k = 1; k <= 150; ++k) {
    asked(plane(1.0, 0.04 * k, 0.0, 1.0), false, 1.0, true);
    ASSERT_EQ(asked.reason[0], "") << k;
    asked.field().commit();
  }
  EXPECT_EQ(copiesAt(asked.field(), 0), 1);
}

}  // namespace
}  // namespace dovetail::hierarchical
