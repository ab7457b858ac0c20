#include "field_profile.hpp"

#include <cmath>
#include <functional>
#include <limits>

namespace dovetail::scene {

namespace {

using PointValue = std::function<double(std::size_t)>;

struct Column {
  std::string name, unit;  ///< "" for pure numbers
  PointValue value;
  PointValue over = {};  ///< the mean is that of `value` over that of this, where it is given
};

std::vector<Column> columnsOf(const cg::Fields& f) {
  const PointValue density = [&f](std::size_t p) { return f.density[p]; };
  std::vector<Column> columns{{"density", "_kg_per_m3", density},
                              {"solid_fraction", "", [&f](std::size_t p) { return f.solidFraction[p]; }}};
  for (int c = 0; c < 3; ++c)
    columns.push_back({std::string("velocity_") + "xyz"[c], "_m_per_s",
                       [&f, c](std::size_t p) { return f.momentum[p][c]; }, density});
  for (const auto& [i, j] : {std::pair{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}})
    columns.push_back({std::string("stress_") + "xyz"[i] + "xyz"[j], "_Pa",
                       [&f, i = i, j = j](std::size_t p) { return f.stress(p)(i, j); }});
  columns.push_back({"pressure", "_Pa", [&f](std::size_t p) { return -f.stress(p).trace() / 3.0; }});
  columns.push_back({"temperature", "_m2_per_s2", [&f](std::size_t p) { return f.temperature[p]; }});
  return columns;
}

/// Mean and standard error over the points of a layer.
std::pair<double, double> meanOf(const Column& column, const std::vector<std::size_t>& layer, double independent) {
  const auto count = static_cast<double>(layer.size());
  double sum = 0.0, over = 0.0, squares = 0.0;
  for (const std::size_t p : layer) {
    sum += column.value(p);
    over += column.over ? column.over(p) : 1.0;
  }
  const double mean = over != 0.0 ? sum / over : 0.0;
  for (const std::size_t p : layer) {
    const double rest = column.value(p) - mean * (column.over ? column.over(p) : 1.0);
    squares += rest * rest;
  }
  if (!(independent >= 2.0) || over == 0.0) return {mean, std::numeric_limits<double>::quiet_NaN()};
  return {mean, std::sqrt(squares / (count - 1.0) / independent) * count / std::abs(over)};
}

}  // namespace

io::TimeSeries profileOf(const cg::Grid& grid, const cg::Fields& fields, int axis, double width) {
  const std::vector<Column> columns = columnsOf(fields);
  std::vector<std::string> names{std::string(1, "xyz"[axis]) + "_m", "independent_places"};
  for (const Column& column : columns) {
    names.push_back(column.name + column.unit);
    names.push_back(column.name + "_error" + column.unit);
  }
  double independent = 1.0;
  for (int c = 0; c < 3; ++c) {
    const int count = grid.count[static_cast<std::size_t>(c)];
    if (c != axis && count > 1) independent *= 1.0 + std::floor((count - 1) * grid.spacing[c] / (2.0 * width));
  }
  io::TimeSeries profile(names);
  const std::array<int, 3>& n = grid.count;
  std::array<int, 3> at{};
  auto& layerAt = at[static_cast<std::size_t>(axis)];
  for (int k = 0; k < n[static_cast<std::size_t>(axis)]; ++k) {
    std::vector<std::size_t> layer;
    for (at[2] = 0; at[2] < n[2]; ++at[2])
      for (at[1] = 0; at[1] < n[1]; ++at[1])
        for (at[0] = 0; at[0] < n[0]; ++at[0])
          if (layerAt == k) layer.push_back(static_cast<std::size_t>(at[0] + n[0] * (at[1] + n[1] * at[2])));
    std::vector<double> row{grid.lower[axis] + k * grid.spacing[axis], independent};
    for (const Column& column : columns) {
      const auto [mean, error] = meanOf(column, layer, independent);
      row.push_back(mean);
      row.push_back(error);
    }
    profile.append(row);
  }
  return profile;
}

}  // namespace dovetail::scene
