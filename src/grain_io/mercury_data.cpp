// .data files of MercuryDPM: a line of the number, the time and the box, and a line for each particle; frames follow
// each other.
#include <array>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "grain_rows.hpp"

namespace dovetail::grain_io {

namespace {

struct Head {
  std::size_t count = 0;
  bool flat = false;
  double time = 0.0;
  geometry::Box box;
};

Head headIn(TextSource& source) {
  const std::vector<std::string_view> words = wordsOf(source.line());
  if (words.size() != 6 && words.size() != 8)
    source.refuse("the head of a frame has " + std::to_string(words.size()) + " numbers",
                  "give 8 (3-D) or 6 (2-D): number of particles, time, lower and upper corner of the box");
  Head head;
  head.flat = words.size() == 6;
  const std::int64_t count = source.parseInteger(words[0]);
  if (count < 0 || static_cast<std::uint64_t>(count) > source.remaining())
    source.refuse("it announces " + std::to_string(count) + " particles, which the file cannot hold",
                  "give a complete file");
  head.count = static_cast<std::size_t>(count);
  head.time = source.parseReal(words[1]);
  const int axes = head.flat ? 2 : 3;
  for (int c = 0; c < axes; ++c) {
    head.box.lower[c] = source.parseReal(words[static_cast<std::size_t>(2 + c)]);
    head.box.upper[c] = source.parseReal(words[static_cast<std::size_t>(2 + axes + c)]);
  }
  return head;
}

Row rowIn(TextSource& source, bool flat) {
  const std::vector<std::string_view> words = wordsOf(source.line());
  const std::size_t columns = flat ? 8 : 14;
  if (words.size() != columns)
    source.refuse("a particle has " + std::to_string(words.size()) + " columns", "give " + std::to_string(columns));
  std::array<double, 13> v{};
  for (std::size_t k = 0; k + 1 < columns; ++k) v[k] = source.parseReal(words[k]);
  Row row = flat ? Row{.position = {v[0], v[1], 0.0},
                       .radius = v[4],
                       .velocity = Vec3{v[2], v[3], 0.0},
                       .spin = Vec3{0.0, 0.0, v[6]}}
                 : Row{.position = {v[0], v[1], v[2]},
                       .radius = v[6],
                       .velocity = Vec3{v[3], v[4], v[5]},
                       .spin = Vec3{v[10], v[11], v[12]}};
  // "info" is the species unless a program writes something else there.
  std::int64_t species = 0;
  if (io::isNumber(words.back(), species))
    row.type = species;
  else if (const double info = source.parseReal(words.back()); std::abs(info) < 1e9)
    row.type = static_cast<std::int64_t>(info);
  else
    row.type = 0;
  return row;
}

void passBlankLines(TextSource& source) {
  while (!source.atEnd()) {
    const std::size_t begin = source.offset();
    if (!trimmed(source.line()).empty()) return source.goTo(begin);
  }
}

}  // namespace

GrainFile mercuryData(TextSource& source, std::int64_t frame) {
  std::vector<std::size_t> begins;
  for (passBlankLines(source); !source.atEnd(); passBlankLines(source)) {
    begins.push_back(source.offset());
    if (frame >= 0 && static_cast<std::int64_t>(begins.size()) > frame) break;
    const Head head = headIn(source);
    for (std::size_t k = 0; k < head.count; ++k) {
      if (source.atEnd() && frame == -1)
        source.refuse(
            "the file breaks off after " + std::to_string(k) + " of " + std::to_string(head.count) + " particles",
            "give a complete file, or take an earlier frame: \"frame\": -2");
      source.endLine();
    }
  }
  source.goTo(begins[frameAt(frame, begins.size(), source.name())]);
  const Head head = headIn(source);
  GrainRows rows(source, {});
  for (std::size_t k = 0; k < head.count; ++k) rows.add(rowIn(source, head.flat));
  rows.file.time = head.time;
  if (head.flat)
    rows.file.notes.emplace_back("The file is of discs in a plane: they are read as spheres at z = 0.");
  else
    rows.file.box = head.box;
  return rows.finish();
}

}  // namespace dovetail::grain_io
