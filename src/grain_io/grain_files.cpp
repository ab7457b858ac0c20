#include "dovetail/grain_io/grain_files.hpp"

#include "dovetail/core/error.hpp"
#include "grain_rows.hpp"

namespace dovetail::grain_io {

namespace {

/// The first line that is not empty.
std::string_view firstLine(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  return begin == std::string_view::npos ? std::string_view{} : text.substr(begin, text.find('\n', begin) - begin);
}

/// How many numbers a line has; 0 if there are words.
std::size_t numbersIn(std::string_view line) {
  const std::vector<std::string_view> words = wordsOf(line);
  double value = 0.0;
  for (const std::string_view word : words)
    if (!io::isNumber(word, value)) return 0;
  return words.size();
}
bool isHeadOfMercury(std::string_view line) { return numbersIn(line) == 6 || numbersIn(line) == 8; }

/// A header such as "100 atoms" within the first lines.
bool hasAtoms(std::string_view text) {
  for (int line = 0; line < 100 && !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::vector<std::string_view> words = wordsOf(text.substr(0, end));
    if (words.size() >= 2 && words[1] == "atoms") return true;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return false;
}

void requireText(std::string_view text, const std::string& where) {
  if (text.starts_with("\x1F\x8B")) throw InputError("the file is packed by gzip", where, "unpack it first");
  if (text.substr(0, 4096).find('\0') != std::string_view::npos)
    throw InputError("the file is no text", where, "write it as a text");
}

template <class Read>
GrainFile readText(const std::filesystem::path& path, const std::string& what, Read&& read) {
  const std::string bytes = io::readWhole(path, what);
  requireText(bytes, path.string());
  std::string room;
  TextSource source(io::plainText(bytes, path.string(), room), path.string());
  return read(source, source.take(source.remaining()));
}

}  // namespace

Code codeOf(std::string_view text, const std::string& where) {
  requireText(text, where);
  const std::string_view line = firstLine(text);
  if (line.starts_with("ITEM:")) return Code::lammps;
  if (line.starts_with("#format")) return Code::yade;
  if (line.starts_with("restart_version") || isHeadOfMercury(line)) return Code::mercury;
  if (hasAtoms(text)) return Code::lammps;
  if (line.starts_with('#') || numbersIn(line) == 4) return Code::yade;
  throw InputError("the file is none that is known", where,
                   "give one of LAMMPS (data, dump), YADE (export.text) or MercuryDPM (restart, data)");
}

GrainFile readLammps(const std::filesystem::path& path, Units units, std::int64_t frame) {
  return readText(path, "a file of LAMMPS", [&](TextSource& source, std::string_view text) {
    source.goTo(0);
    if (firstLine(text).starts_with("ITEM:")) return lammpsDump(source, units, frame);
    if (frame != -1) throw InputError("a data file has one frame", source.name(), "leave out \"frame\"");
    return lammpsData(source, units);
  });
}

GrainFile readMercury(const std::filesystem::path& path, std::int64_t frame) {
  return readText(path, "a file of MercuryDPM", [&](TextSource& source, std::string_view text) {
    source.goTo(0);
    if (isHeadOfMercury(firstLine(text))) return mercuryData(source, frame);
    if (!firstLine(text).starts_with("restart_version"))
      throw InputError("the file is no restart or data file of MercuryDPM", source.name(),
                       "give one that begins with restart_version, or with the number of particles");
    if (frame != -1) throw InputError("a restart file has one frame", source.name(), "leave out \"frame\"");
    return mercuryRestart(source);
  });
}

}  // namespace dovetail::grain_io
