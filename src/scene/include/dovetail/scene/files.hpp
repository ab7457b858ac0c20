// Files of other kinds than scenes, by the same rules: comments, units, parameters, included files, strict keys.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "dovetail/scene/fields.hpp"

namespace dovetail::scene {

struct FileText {
  std::string text, name;        ///< the name is for messages
  std::filesystem::path folder;  ///< that names of files are relative to
};
/// @throws InputError if it cannot be read
FileText textOfFile(const std::filesystem::path& file);

struct ReadFields {
  std::string functionsOfTime;      ///< all expressions of the time
  std::vector<std::string> files;   ///< that were read or are going to be: the file, those it includes and names
  std::vector<std::string> unused;  ///< unused parameters of the file itself
};
/// Calls describeFile twice: for the keys, when values stay as they are, then for the values; each time on a structure
/// of its own.
/// @throws InputError as readScene
ReadFields readFields(const FileText& file, const std::vector<std::string>& settings,
                      const std::function<void(Fields&)>& describeFile);

/// All keys with their values, in SI units.
std::string textOf(const std::function<void(Fields&)>& describeFile);

/// JSON Schema of a kind of file ("scene"), and its keys as tables in Markdown.
std::string schemaText(const std::string& kind, const std::function<void(Fields&)>& describeFile);
std::string referenceText(const std::string& kind, const std::function<void(Fields&)>& describeFile);

/// 16 digits of FNV-1a, by which files name a scene.
std::string hashOf(const std::string& text);

}  // namespace dovetail::scene
