// The text of an INP file with those of the files that it names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dovetail/io/text_source.hpp"

namespace dovetail::solid_io {

struct InpText {
  std::string text;
  std::vector<io::TextSource::Piece> pieces;
};

/// Files of *INCLUDE, and of INPUT on *NODE and *ELEMENT, stand in place of these cards, or behind them. Names are
/// relative to the folder of the deck, or else to that of the file that names them.
/// @param name  of the deck
/// @throws InputError for files that are not there, include each other, or are nested more than 16 deep
InpText withIncludes(std::string_view bytes, const std::string& name);

}  // namespace dovetail::solid_io
