// Tables of the matrix.
#pragma once

#include <string>
#include <vector>

#include "dovetail/io/provenance.hpp"
#include "matrix_figures.hpp"

namespace dovetail::coupling_matrix {

struct Row {
  Case c;
  Figures figures;
};

/// One line per case below the provenance and a line of names.
std::string csvOf(const std::vector<Row>& rows, const io::KeyValues& provenance);
/// The worst of the cases of every level of every factor, who falls short of what, who is refused and why.
std::string markdownOf(const std::vector<Row>& rows);

}  // namespace dovetail::coupling_matrix
