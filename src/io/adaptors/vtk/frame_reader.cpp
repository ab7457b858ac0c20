#include "dovetail/io_vtk/frame_reader.hpp"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "vtk_xml.hpp"

namespace dovetail::io {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path) {
  throw InputError("the file is no frame, or damaged", path.string(), "give a complete VTU, VTP or VTI file");
}

void addArrays(FrameContent& content, vtkFieldData* data, bool perCell) {
  for (int k = 0; k < data->GetNumberOfArrays(); ++k) {
    vtkDataArray* const array = data->GetArray(k);
    if (!array || !array->GetName()) continue;
    FrameArray& added = content.arrays.emplace_back();
    added.name = array->GetName();
    added.perCell = perCell;
    added.components = array->GetNumberOfComponents();
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
      for (int c = 0; c < added.components; ++c) added.values.push_back(array->GetComponent(i, c));
  }
}

void addCells(FrameContent& content, vtkDataSet* set) {
  const vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; cell < set->GetNumberOfCells(); ++cell) {
    set->GetCellPoints(cell, points);
    content.cellType.push_back(set->GetCellType(cell));
    for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
      content.cellPoint.push_back(static_cast<std::size_t>(points->GetId(k)));
    content.cellEnd.push_back(content.cellPoint.size());
  }
}

void addFieldData(FrameContent& content, vtkFieldData* data) {
  if (vtkDataArray* const time = data->GetArray("TimeValue"); time && time->GetNumberOfTuples() > 0)
    content.time = time->GetComponent(0, 0);
  if (auto* const lines = vtkStringArray::SafeDownCast(data->GetAbstractArray("provenance")))
    for (vtkIdType i = 0; i < lines->GetNumberOfValues(); ++i) content.provenance.push_back(lines->GetValue(i));
}

FrameContent contentOf(vtkDataSet* set, const char* kind) {
  FrameContent content;
  content.kind = kind;
  content.cells = static_cast<std::size_t>(set->GetNumberOfCells());
  for (vtkIdType i = 0; i < set->GetNumberOfPoints(); ++i) {
    double x[3];
    set->GetPoint(i, x);
    content.position.push_back({x[0], x[1], x[2]});
  }
  if (content.kind != "VTI") addCells(content, set);
  addArrays(content, set->GetPointData(), false);
  addArrays(content, set->GetCellData(), true);
  addFieldData(content, set->GetFieldData());
  return content;
}

/// Truncated data may read as far as they go.
void requireEnd(const fs::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file.tellg(), tail = std::min<std::streamoff>(size, 32);
  std::string end(static_cast<std::size_t>(std::max<std::streamoff>(tail, 0)), '\0');
  file.seekg(size - tail);
  file.read(end.data(), tail);
  if (end.find("</VTKFile>") == std::string::npos) refuse(path);
}

template <class Reader>
FrameContent read(const fs::path& path, const char* kind, const char* type) {
  requireEnd(path);
  return contentOf(readVtkXml<Reader>(path, kind, type, 0), kind);
}

}  // namespace

const FrameArray* FrameContent::find(const std::string& name, bool perCell) const {
  for (const FrameArray& array : arrays)
    if (array.name == name && array.perCell == perCell) return &array;
  return nullptr;
}

FrameContent readFrame(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) throw InputError("there is no such file", path.string(), "correct its name");
  const std::string ending = path.extension().string();
  if (ending == ".vtu") return read<vtkXMLUnstructuredGridReader>(path, "VTU", "UnstructuredGrid");
  if (ending == ".vtp") return read<vtkXMLPolyDataReader>(path, "VTP", "PolyData");
  if (ending == ".vti") return read<vtkXMLImageDataReader>(path, "VTI", "ImageData");
  refuse(path);
}

std::vector<std::pair<double, fs::path>> readPvd(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text.find("type=\"Collection\"") == std::string::npos)
    throw InputError("the file is no PVD series", path.string(), "give one that a run wrote");
  std::vector<std::pair<double, fs::path>> frames;
  for (std::size_t at = text.find("<DataSet"); at != std::string::npos; at = text.find("<DataSet", at + 1)) {
    const std::string_view tag = std::string_view(text).substr(at, text.find('>', at) - at);
    double time = 0.0;
    if (!isNumber(detail::attribute(tag, "timestep", ""), time))
      throw InputError("a frame of the series has no time", path.string(), "give a complete file");
    frames.emplace_back(time, path.parent_path() / detail::attribute(tag, "file", ""));
  }
  return frames;
}

}  // namespace dovetail::io
