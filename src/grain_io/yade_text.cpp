// Texts of YADE: a line "#format", comments, and rows of numbers.
#include <algorithm>
#include <array>

#include "dovetail/core/error.hpp"
#include "grain_rows.hpp"

namespace dovetail::grain_io {

namespace {

struct Format {
  std::string_view name;
  std::size_t first, columns;  ///< where x stands; columns at least
  bool id, material, more;
};
constexpr std::array<Format, 4> formats{{{"x_y_z_r", 0, 4, false, false, false},
                                         {"x_y_z_r_matId", 0, 5, false, true, false},
                                         {"x_y_z_r_attrs", 0, 4, false, false, true},
                                         {"id_x_y_z_r_matId", 1, 6, true, true, false}}};

Format formatNamed(std::string_view name, const TextSource& source) {
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const Format& one) { return one.name == name; });
  if (found != formats.end()) return *found;
  if (name.find("clumpId") != std::string_view::npos)
    source.refuse("the format " + std::string(name) + " is of clumps, which are not read",
                  "give their spheres as \"clumps\" of the scene");
  source.refuse("the format is " + shown(name), "export x_y_z_r, x_y_z_r_matId or x_y_z_r_attrs");
}

}  // namespace

GrainFile readYade(const std::filesystem::path& path) {
  const std::string bytes = io::readWhole(path, "a text of YADE");
  std::string room;
  TextSource source(io::plainText(bytes, path.string(), room), path.string());
  GrainRows rows(source, {});
  Format format = formats[0];
  bool more = false;
  while (!source.atEnd()) {
    const std::vector<std::string_view> words = wordsOf(source.line());
    if (words.empty()) continue;
    if (words[0] == "#format") {
      if (rows.file.size() > 0) source.refuse("the format changes", "give one file for each");
      format = formatNamed(words.size() > 1 ? words[1] : "", source);
      continue;
    }
    if (words[0].front() == '#') continue;
    if (words.size() < format.columns || (words.size() > format.columns && !format.more))
      source.refuse("a row has " + std::to_string(words.size()) + " values",
                    "give " + std::to_string(format.columns) + " for the format " + std::string(format.name));
    more |= words.size() > format.columns;
    const auto real = [&](std::size_t k) { return source.parseReal(words[format.first + k]); };
    Row row{.position = {real(0), real(1), real(2)}, .radius = real(3)};
    if (format.id) row.id = source.parseInteger(words[0]);
    if (format.material) row.type = source.parseInteger(words[format.columns - 1]);
    rows.add(row);
  }
  if (more) rows.file.notes.emplace_back("Further attributes of the spheres are not read.");
  return rows.finish();
}

}  // namespace dovetail::grain_io
