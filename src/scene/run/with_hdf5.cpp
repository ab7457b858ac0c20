// Series and solids as HDF5.
#include <algorithm>

#include "build/parts.hpp"
#include "dovetail/io_hdf5/time_series_hdf5.hpp"
#include "dovetail/io_hdf5/vtkhdf.hpp"
#include "dovetail/solid_io/vtk_cell_types.hpp"
#include "frame_fields.hpp"
#include "inspect/comparing.hpp"
#include "inspect/inspecting.hpp"
#include "series.hpp"

namespace dovetail::scene {

void requireHdf5() {}
void writeSeriesHdf5(const std::filesystem::path& path, const io::TimeSeries& table, const io::KeyValues& provenance) {
  io::writeHdf5(path, table, provenance);
}

void writeSolidsHdf5(const std::filesystem::path& folder, const Built& built, const Scene& scene,
                     const io::KeyValues& provenance) {
  constexpr unsigned char vertex = 1;  // VTK_VERTEX
  const std::vector<std::string>& contents = scene.output.contents;
  if (std::find(contents.begin(), contents.end(), "solids") == contents.end()) return;
  for (std::size_t s = 0; s < built.meshes.size(); ++s) {
    const fem::SolidMesh& mesh = built.meshes[s];
    const coupling::SolidSide& side = built.run->solid(s);
    const std::vector<MeshField> values = solidFields(*side.model, mesh.elementCount(), scene.solids[s], contents);
    io::HdfGrid grid{.points = mesh.X, .connectivity = {}, .offsets = {0}, .types = {}, .fields = {}};
    for (const fem::ElementGroup& group : mesh.groups) {
      grid.connectivity.insert(grid.connectivity.end(), group.node.begin(), group.node.end());
      for (std::size_t e = 0; e < group.size(); ++e) {
        grid.offsets.push_back(grid.offsets.back() + fem::nodesOf(group.shape));
        grid.types.push_back(solid_io::vtkCellType(group.shape));
      }
    }
    for (std::size_t p = 0; isOfPoints(scene.solids[s]) && p < mesh.X.size(); ++p) {
      grid.connectivity.push_back(static_cast<int>(p));
      grid.offsets.push_back(grid.offsets.back() + 1);
      grid.types.push_back(vertex);
    }
    for (const MeshField& field : values)
      grid.fields.push_back({field.name, field.values, field.components, field.perCell});
    io::writeVtkHdf(folder / ("solid_" + side.name + ".vtkhdf"), built.run->time(), grid, provenance);
  }
}

io::TimeSeries readSeriesHdf5(const std::filesystem::path& file) { return io::readHdf5(file); }
io::KeyValues readProvenanceHdf5(const std::filesystem::path& file) { return io::readHdf5Provenance(file); }

}  // namespace dovetail::scene
