// From plain arrays to those of VTK, and from data sets to the text of XML files.
#pragma once

#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/io/provenance.hpp"

namespace dovetail::io {

static_assert(sizeof(Vec3) == 3 * sizeof(double), "the bytes of a Vec3 are copied as three doubles");

inline void fill(vtkDoubleArray* array, const std::string& name, int components, std::size_t count,
                 const void* values) {
  array->SetName(name.c_str());
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(count));
  if (count > 0)
    std::memcpy(array->GetPointer(0), values, static_cast<std::size_t>(components) * count * sizeof(double));
}

inline void addField(vtkFieldData* data, const std::string& name, std::span<const Vec3> values) {
  vtkNew<vtkDoubleArray> array;
  fill(array, name, 3, values.size(), values.data());
  data->AddArray(array);
}

inline void addField(vtkFieldData* data, const std::string& name, std::span<const double> values, int components = 1) {
  vtkNew<vtkDoubleArray> array;
  fill(array, name, components, values.size() / static_cast<std::size_t>(components), values.data());
  data->AddArray(array);
}

inline void addField(vtkFieldData* data, const std::string& name, std::span<const std::int64_t> values) {
  vtkNew<vtkTypeInt64Array> array;
  array->SetName(name.c_str());
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  data->AddArray(array);
}

inline void addTime(vtkDataObject* set, double time) {
  addField(set->GetFieldData(), "TimeValue", std::span<const double>(&time, 1));
}

inline void addProvenance(vtkDataObject* set, const KeyValues& provenance) {
  vtkNew<vtkStringArray> lines;
  lines->SetName("provenance");
  for (const auto& [key, value] : provenance) lines->InsertNextValue(key + ": " + value);
  set->GetFieldData()->AddArray(lines);
}

enum class Compressed { no, yes };

/// @param Writer  of VTK's XML format for this kind of data set. @throws Error if VTK fails
template <class Writer>
std::string xmlText(vtkDataObject* set, Compressed compressed = Compressed::yes) {
  vtkNew<Writer> writer;
  writer->SetInputData(set);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  if (compressed == Compressed::yes)
    writer->SetCompressorTypeToZLib();
  else
    writer->SetCompressorTypeToNone();
  writer->SetHeaderTypeToUInt64();
  writer->WriteToOutputStringOn();
  if (writer->Write() == 0) throw Error("VTK could not write a frame", "", "see what it printed above");
  std::string text = writer->GetOutputString();
  // The mark of our files; what follows may be compressed. Offsets in the file count from the appended section.
  const std::size_t root = text.find("<VTKFile");
  if (root == std::string::npos) throw Error("VTK wrote a frame without a root element", "", "check its version");
  return text.insert(root, "<!-- dovetail " + buildInfo().version + " -->\n");
}

}  // namespace dovetail::io
