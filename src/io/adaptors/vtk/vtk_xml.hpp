// Reads an XML file by VTK's readers, which take some damaged files for granted and end the program: what is known to
// do so is refused before.
#pragma once

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::io {

[[noreturn]] inline void refuseVtk(const std::filesystem::path& path, const std::string& place,
                                   const std::string& problem, const std::string& remedy) {
  throw InputError(problem, place.empty() ? path.string() : path.string() + ", " + place, remedy);
}

namespace detail {

/// The value of an attribute within a tag, `otherwise` if it is not there.
inline std::string_view attribute(std::string_view tag, std::string_view name, std::string_view otherwise) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    const std::size_t value = at + name.size() + 2;
    if (at == 0 || tag[at - 1] > ' ' || tag.substr(at + name.size(), 2) != "=\"") continue;
    return tag.substr(value, std::min(tag.find('"', value), tag.size()) - value);
  }
  return otherwise;
}

template <class Number>
bool isWholly(std::string_view word, Number& value) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size();
}

/// Whether VTK's streams read the word as a number of the type; not "nan".
inline bool isNumberOf(std::string_view type, std::string_view word) {
  double real = 0.0;
  long long whole = 0;
  unsigned long long positive = 0;
  if (type.starts_with("Float")) return isWholly(word, real) && real - real == 0.0;
  if (type == "UInt64") return isWholly(word, positive);
  if (!isWholly(word, whole)) return false;
  if (type == "Int64") return true;
  const int bits = type.ends_with("32") ? 32 : type.ends_with("16") ? 16 : 8;
  const long long most = 1ll << (type.starts_with("U") ? bits : bits - 1);
  return whole < most && whole >= (type.starts_with("U") ? 0 : -most);
}

/// Counts that no file of that size could fill: zlib packs a thousand bytes into one at most.
inline void requirePlausibleCounts(std::string_view tag, std::size_t fileSize, const std::filesystem::path& path) {
  for (std::size_t at = tag.find("NumberOf"); at != std::string_view::npos; at = tag.find("NumberOf", at + 1)) {
    const std::string_view name = tag.substr(at, tag.find_first_of("= \t\r\n", at) - at);
    const std::string_view value = attribute(tag, name, "0");
    std::size_t count = 0;
    if (!isWholly(value, count) || count > 1032 * fileSize)
      refuseVtk(path, "", "it has " + std::string(name) + "=\"" + std::string(value.substr(0, 24)) + "\"",
                "give a complete file");
  }
}

inline void requireKnownType(std::string_view type, const std::filesystem::path& path) {
  for (const char* known :
       {"Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Float32", "Float64"})
    if (type == known) return;
  refuseVtk(path, "", "an array is of type \"" + std::string(type.substr(0, 24)) + "\"",
            "give Int8 to UInt64, Float32 or Float64");
}

/// Compressed blocks are read by what the root says of their headers.
inline void requireKnownRoot(std::string_view tag, const std::filesystem::path& path) {
  std::size_t known = 0;
  for (const char* name : {"type", "version", "byte_order", "header_type", "compressor"})
    known += attribute(tag, name, "").empty() ? 0 : 1;
  const auto given = static_cast<std::size_t>(std::count(tag.begin(), tag.end(), '='));
  if (given != known)
    refuseVtk(path, "", "the root element has attributes that are not known",
              "give type, version, byte_order, header_type and compressor");
}

inline void requireNumbers(std::string_view type, std::string_view content, const std::filesystem::path& path) {
  constexpr std::string_view blanks = " \t\r\n";
  for (std::size_t at = content.find_first_not_of(blanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(content.find_first_of(blanks, at), content.size());
    if (!isNumberOf(type, content.substr(at, end - at))) {
      std::string problem(content.substr(at, std::min<std::size_t>(end - at, 24)));
      problem.append(" is no ").append(type);
      refuseVtk(path, "", problem, "give finite numbers of the array's type");
    }
    at = content.find_first_not_of(blanks, end);
  }
}

/// Looks at the counts of all tags and at the numbers of all arrays in ASCII.
inline void requireReadable(const std::filesystem::path& path) {
  std::ifstream file = openFile(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::string_view text = std::string_view(bytes).substr(0, bytes.find("<AppendedData"));
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at + 1)) {
    const std::size_t end = text.find('>', at);
    if (end == std::string_view::npos) return;
    const std::string_view tag = text.substr(at, end - at);
    requirePlausibleCounts(tag, bytes.size(), path);
    if (tag.starts_with("<VTKFile")) requireKnownRoot(tag, path);
    if (tag.starts_with("<Array") && attribute(tag, "type", "") != "String")
      requireKnownType(attribute(tag, "type", ""), path);
    if (tag.starts_with("<DataArray")) requireKnownType(attribute(tag, "type", ""), path);
    const bool ascii = tag.starts_with("<DataArray") && attribute(tag, "format", "ascii") == "ascii";
    if (!ascii || tag.ends_with('/')) continue;
    const std::size_t close = std::min(text.find('<', end), text.size());
    requireNumbers(attribute(tag, "type", "Float64"), text.substr(end + 1, close - end - 1), path);
  }
}

/// The first line that says something of what VTK would have printed.
inline std::string firstLine(const std::string& text) {
  const std::size_t colon = text.find("): ");
  const std::size_t begin = colon == std::string::npos ? 0 : colon + 3;
  return text.substr(begin, text.find('\n', begin) - begin);
}

/// Whether VTK gets through the file. Its messages are off, since putting one together about an array that cannot be
/// read is what ends the program (VTK 9.1); a file that gives no points counts as not read, unless there may be none.
template <class Reader>
bool isReadQuietly(const std::filesystem::path& path, std::size_t leastPoints) {
  const int before = vtkObject::GetGlobalWarningDisplay();
  vtkObject::GlobalWarningDisplayOff();
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  bool good = true;
  try {
    reader->Update();
  } catch (const std::exception&) {  // std::bad_alloc, std::length_error
    good = false;
  }
  vtkObject::SetGlobalWarningDisplay(before);
  return good && reader->GetErrorCode() == 0 &&
         static_cast<std::size_t>(reader->GetOutput()->GetNumberOfPoints()) >= leastPoints;
}

}  // namespace detail

/// What the reader makes of the file. @param kind "VTU"; `type`: VTK's name of what the file must hold
/// @param leastPoints  0: files of frames in which nothing was there are read too
/// @throws InputError with VTK's first complaint
template <class Reader>
auto readVtkXml(const std::filesystem::path& path, const std::string& kind, const std::string& type,
                std::size_t leastPoints = 1) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    refuseVtk(path, "", "a mesh cannot be read", "give a file that exists and may be read");
  std::string complaint;
  vtkNew<vtkCallbackCommand> listener;
  listener->SetClientData(&complaint);
  listener->SetCallback([](vtkObject*, unsigned long, void* client, void* text) {
    auto& first = *static_cast<std::string*>(client);
    if (!first.empty()) return;
    first = text != nullptr ? detail::firstLine(static_cast<const char*>(text)) : "VTK gives no reason";
  });
  vtkNew<Reader> reader;
  for (const unsigned long event : {vtkCommand::ErrorEvent, vtkCommand::WarningEvent}) {
    reader->AddObserver(event, listener);
    reader->GetExecutive()->AddObserver(event, listener);
  }
  reader->SetReaderErrorObserver(listener);
  reader->SetParserErrorObserver(listener);
  const auto reason = [&] { return complaint.empty() ? "" : " (" + complaint + ")"; };
  if (reader->CanReadFile(path.c_str()) == 0)
    refuseVtk(path, "", "the file is no complete " + kind + " file" + reason(),
              "give an XML file of VTK's type " + type);
  detail::requireReadable(path);
  if (!detail::isReadQuietly<Reader>(path, leastPoints))
    refuseVtk(path, "", "the file cannot be read, or is empty", "give a complete " + kind + " file");
  reader->SetFileName(path.c_str());
  reader->Update();
  if (!complaint.empty() || reader->GetErrorCode() != 0)
    refuseVtk(path, "", "the file cannot be read" + reason(), "give a complete " + kind + " file");
  return vtkSmartPointer(reader->GetOutput());
}

}  // namespace dovetail::io
