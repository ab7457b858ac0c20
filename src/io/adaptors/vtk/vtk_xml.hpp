// Reads an XML file by VTK's readers, which take some damaged files for granted and end the program: what is known to
// do so is refused before.
#pragma once

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkDataSet.h>
#include <vtkExecutive.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <string>

#include "dovetail/core/vec3.hpp"
#include "vtk_xml_text.hpp"

namespace dovetail::io {

namespace detail {

/// The first line that says something of what VTK would have printed.
inline std::string firstLine(const std::string& text) {
  const std::size_t colon = text.find("): ");
  const std::size_t begin = colon == std::string::npos ? 0 : colon + 3;
  return text.substr(begin, text.find('\n', begin) - begin);
}

/// What VTK says of such a file names something beside the points.
inline void requireFinitePoints(vtkDataSet* set, const std::filesystem::path& path) {
  for (vtkIdType i = 0; i < set->GetNumberOfPoints(); ++i) {
    double p[3];
    set->GetPoint(i, p);
    if (!isFinite(Vec3{p[0], p[1], p[2]}))
      refuseVtk(path, "point " + std::to_string(i), "a coordinate is NaN or infinite", "give finite numbers");
  }
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
  if (!good || reader->GetErrorCode() != 0) return false;
  requireFinitePoints(reader->GetOutput(), path);
  return static_cast<std::size_t>(reader->GetOutput()->GetNumberOfPoints()) >= leastPoints;
}

}  // namespace detail

/// What the reader makes of the file. @param kind "VTU"; `type`: VTK's name of what the file must hold
/// @param leastPoints  0: files of frames in which nothing was there are read too
/// @throws InputError naming a point that is not finite, or else with VTK's first complaint
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
