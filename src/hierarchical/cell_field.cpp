#include "dovetail/hierarchical/cell_field.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "cell_points.hpp"
#include "farm/farmed_field.hpp"
#include "samples.hpp"

namespace dovetail::hierarchical {

namespace {

template <class Settings>
std::shared_ptr<fem::PointField> fieldOf(std::vector<rve::Rve> samples, double unbalanced, const Settings& settings,
                                         Deal deal) {
  validateSamples(samples, unbalanced);
  if (!deal) deal = [n = samples.size()](const fem::PointPlace& place) { return inTurn(place) % n; };
  const auto shared = std::make_shared<const std::vector<rve::Rve>>(std::move(samples));
  if (Mail* const mail = mailOfFarm(); mail != nullptr && mayTravel(*shared))
    return farmedField({shared, settings}, std::move(deal), *mail);
  return fem::pointField(
      {.name = nameOf(*shared), .density = meanDensity(*shared)},
      [make = cellMaker(shared, settings), deal](const fem::PointPlace& place) { return make(deal(place)); });
}

}  // namespace

std::size_t inTurn(const fem::PointPlace& place) {
  return static_cast<std::size_t>(std::max(place.element, 0) + place.point);
}

bool visitCell(const fem::PointField& field, std::size_t point, const std::function<void(const rve::Rve&)>& visit) {
  const auto* const owner = dynamic_cast<const CellOwner*>(field.point(point));
  if (owner) owner->visitCommitted(visit);
  return owner != nullptr;
}

bool hasCell(const fem::PointField& field, std::size_t point) {
  return farmReport(field) != nullptr || dynamic_cast<const CellOwner*>(field.point(point)) != nullptr;
}

int copiesAt(const fem::PointField& field, std::size_t point) {
  if (const std::optional<int> copies = copiesInFarm(field, point)) return *copies;
  const auto* const owner = dynamic_cast<const CellOwner*>(field.point(point));
  return owner ? owner->copies() : 0;
}

std::shared_ptr<fem::PointField> cellField(std::vector<rve::Rve> samples, const QuasiStaticCells& settings, Deal deal) {
  return fieldOf(std::move(samples), settings.unbalanced, settings, std::move(deal));
}

std::shared_ptr<fem::PointField> cellField(std::vector<rve::Rve> samples, const DynamicCells& settings, Deal deal) {
  return fieldOf(std::move(samples), RestCriterion{}.tolerance, settings, std::move(deal));
}

}  // namespace dovetail::hierarchical
