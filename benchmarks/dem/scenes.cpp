#include "scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"

namespace dovetail::dem_benchmark {

namespace {

/// Uniform in [−half, half]: own arithmetic, because the standard distributions differ between libraries.
double jitter(std::mt19937_64& random, double half) {
  return half * (2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0);
}

/// Numbers of these files read back to the same bits.
std::ostringstream exactText() {
  std::ostringstream out;
  out.precision(17);
  return out;
}

/// Refuses spheres that no bed could hold, and two in one place, whose contact would have no direction.
void requireSensible(const Spheres& spheres, const std::vector<int>& lines, const std::string& file) {
  constexpr double most = 1e6;  // diameters of a sphere of 1
  std::map<std::array<double, 3>, int> seen;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vec3& x = spheres.x[i];
    const std::string where = file + ", line " + std::to_string(lines[i]);
    if (std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z), spheres.diameter[i]}) > most)
      throw InputError("a sphere is larger or farther away than 1e6", where, "give a bed of spheres of diameter 1");
    const auto [other, isNew] = seen.emplace(std::array{x.x, x.y, x.z}, lines[i]);
    if (!isNew)
      throw InputError("the sphere lies where that of line " + std::to_string(other->second) + " does", where,
                       "give each sphere a place of its own");
  }
}

double periodicDistance(const Vec3& a, const Vec3& b, double edge) {
  Vec3 d = a - b;
  for (int k = 0; k < 3; ++k) d[k] -= edge * std::round(d[k] / edge);
  return norm(d);
}

}  // namespace

Spheres readSpheres(const std::filesystem::path& path) {
  std::ifstream in(path);
  if (!in) throw InputError("the file cannot be read", path.string(), "give a file with lines 'x y z diameter'");
  Spheres spheres;
  std::vector<int> lines;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.starts_with('#')) continue;
    std::istringstream fields(line);
    Vec3 x;
    double diameter = 0.0;
    if (!(fields >> x.x >> x.y >> x.z >> diameter) || !isFinite(x) || !(diameter > 0.0))
      throw InputError("not 'x y z diameter'", path.string() + ", line " + std::to_string(number),
                       "give four numbers, the last one greater than zero");
    spheres.x.push_back(x);
    spheres.diameter.push_back(diameter);
    lines.push_back(number);
    if ((fields >> std::ws).eof()) continue;
    Vec3 v, omega;
    if (!(fields >> v.x >> v.y >> v.z >> omega.x >> omega.y >> omega.z) || !(fields >> std::ws).eof() || !isFinite(v) ||
        !isFinite(omega))
      throw InputError("the columns after the diameter are not velocity and spin",
                       path.string() + ", line " + std::to_string(number), "give 4 numbers or 10");
    spheres.v.push_back(v);
    spheres.omega.push_back(omega);
  }
  if (!spheres.v.empty() && spheres.v.size() != spheres.size())
    throw InputError("some lines have velocities and others have none", path.string(), "give them to all or to none");
  if (spheres.size() == 0) throw InputError("no spheres", path.string(), "give lines 'x y z diameter'");
  requireSensible(spheres, lines, path.string());
  return spheres;
}

void writeSpheres(const std::filesystem::path& path, const Spheres& spheres) {
  auto out = exactText();
  out << "# dovetail " << io::buildInfo().version << ": x y z diameter, then velocity and spin if they have one\n";
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    out << spheres.x[i].x << ' ' << spheres.x[i].y << ' ' << spheres.x[i].z << ' ' << spheres.diameter[i];
    if (!spheres.v.empty())
      for (const Vec3& a : {spheres.v[i], spheres.omega[i]}) out << ' ' << a.x << ' ' << a.y << ' ' << a.z;
    out << '\n';
  }
  io::writeFileAtomically(path, out.str());
}

void writeLammpsData(const std::filesystem::path& path, const Spheres& spheres, const geometry::Box& box) {
  auto out = exactText();
  double smallest = spheres.diameter[0];
  for (const double d : spheres.diameter) smallest = std::min(smallest, d);
  out << "spheres, written by dovetail " << io::buildInfo().version << "\n\n"
      << spheres.size() << " atoms\n2 atom types\n\n";
  const char* names[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k)
    out << box.lower[k] << ' ' << box.upper[k] << ' ' << names[k] << "lo " << names[k] << "hi\n";
  out << "\nAtoms # sphere\n\n";
  for (std::size_t i = 0; i < spheres.size(); ++i)
    out << i + 1 << ' ' << (spheres.diameter[i] > 2.0 * smallest ? 2 : 1) << ' ' << spheres.diameter[i]
        << " 1.9098593171 " << spheres.x[i].x << ' ' << spheres.x[i].y << ' ' << spheres.x[i].z << '\n';
  if (!spheres.v.empty()) out << "\nVelocities\n\n";
  for (std::size_t i = 0; i < spheres.v.size(); ++i) {
    out << i + 1;
    for (const Vec3& a : {spheres.v[i], spheres.omega[i]}) out << ' ' << a.x << ' ' << a.y << ' ' << a.z;
    out << '\n';
  }
  io::writeFileAtomically(path, out.str());
}

dem::FrictionalLaw frictionalLaw() {
  // c = γ m* and ω² = k/m* give e = exp(−γ/2 π/√(k/m* − γ²/4)); for m* = 1/2 kg.
  constexpr double pi = 3.14159265358979324, rate = 50.0, effectiveMass = 0.5;
  const double e = std::exp(-0.5 * rate * pi / std::sqrt(stiffness / effectiveMass - 0.25 * rate * rate));
  return {{stiffness, e, true}, {2.0 / 7.0 * stiffness, 0.5, 0.5}};
}

dem::HertzMindlinLaw hertzLaw() {
  // LAMMPS: F = k √(R* δ) δ with k = 20 000 = 4/3 E*; k_t = 2/7 k √(R* δ) = 8 G* √(R* δ).
  dem::HertzMindlinLaw law;
  law.normal.effectiveModulus = 15000.0;
  law.normal.restitution = 0.3;
  law.tangential.stiffnessRatio = 2.0 / 7.0 * 20000.0 / (2.0 * 15000.0);
  law.tangential.friction = 0.5;
  return law;
}

Spheres lattice(int nx, int ny, int nz, double diameter) {
  Spheres spheres;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        spheres.x.push_back({i + 0.5, j + 0.5, k + 0.5});
        spheres.diameter.push_back(diameter);
      }
  return spheres;
}

dem::Model makeModel(const Spheres& spheres, std::shared_ptr<const dem::ContactLaws> laws,
                     const geometry::Periodicity& periodicity, const Vec3& gravity, double skin) {
  dem::Model model;
  model.laws = std::move(laws);
  model.gravity = gravity;
  model.booking = dem::Booking::off;
  model.sortEvery = 0;
  constexpr double density = 1.9098593171;  // a sphere of diameter 1 m has 1 kg
  for (std::size_t i = 0; i < spheres.size(); ++i)
    addParticle(model.particles, spheres.x[i], {}, 0.5 * spheres.diameter[i], dem::Density{density});
  const bool rotates = model.laws->rotates();
  if (rotates) switchOnRotation(model.particles);
  for (std::size_t i = 0; i < spheres.v.size(); ++i) {
    model.particles.v[i] = spheres.v[i];
    if (rotates) model.particles.omega[i] = spheres.omega[i];
  }
  model.pairs.setPeriodicity(periodicity);
  model.pairs.setSkin(skin);
  findPairs(model.particles, model.pairs);
  sortParticles(model.particles, model.pairs);
  return model;
}

dem::Model bedModel(const Spheres& bed, std::shared_ptr<const dem::ContactLaws> laws, double width, double skin) {
  geometry::Periodicity sideways{{{0, 0, 0}, {width, 20, 1}}, {true, true, false}};
  auto model = makeModel(bed, std::move(laws), sideways, {0, 0, -1}, skin);
  dem::addWall(model, dem::makePlane({}, {0, 0, 1})).skin = skin;
  return model;
}

Spheres settledBed(int width, int layers) {
  std::mt19937_64 random(4711);
  Spheres spheres = lattice(width, width, layers, 1.0);
  for (Vec3& x : spheres.x) {
    x = {x.x + jitter(random, 0.1), x.y + jitter(random, 0.1), 1.02 * x.z + 0.1 + jitter(random, 0.05)};
  }
  auto model = bedModel(spheres, frictionalLaw(), width);
  geometry::Periodicity wider = model.pairs.periodicity();
  wider.box.upper.y = width;
  model.pairs.setPeriodicity(wider);
  findPairs(model.particles, model.pairs);
  // A soft landing, then the breathing of the column.
  for (const auto& [rate, steps] : {std::pair{1.0, 2000}, {0.1, 4000}, {2.0, 5000}}) {
    dem::damping(model).viscousRate = rate;
    run(model, timeStep, steps);
  }
  spheres.x = model.particles.x;
  for (Vec3& x : spheres.x)
    for (int k = 0; k < 2; ++k) x[k] -= width * std::floor(x[k] / width);
  return spheres;
}

Spheres flowingDrum() {
  std::mt19937_64 random(4711);
  Spheres spheres;
  const double inside = drumRadius - 0.6;
  for (double z = 0.5; z < drumWidth; z += 1.0)
    for (double y = -drumRadius; y < 0.12 * drumRadius; y += 1.03)
      for (double x = -drumRadius; x < drumRadius; x += 1.03) {
        const Vec3 at{x + jitter(random, 0.01), y + jitter(random, 0.01), z + jitter(random, 0.01)};
        if (at.x * at.x + at.y * at.y > inside * inside) continue;
        spheres.x.push_back(at);
        spheres.diameter.push_back(1.0);
      }
  auto model = drumModel(spheres, drumWidth);
  run(model, drumStep, 37500);
  wrapPositions(model.particles, model.pairs.periodicity());
  spheres.x = model.particles.x;
  spheres.v = model.particles.v;
  spheres.omega = model.particles.omega;
  return spheres;
}

dem::Model drumModel(const Spheres& spheres, double length, double skin) {
  const double r = drumRadius;
  auto model =
      makeModel(spheres, frictionalLaw(), {{{-r, -r, 0}, {r, r, length}}, {false, false, true}}, {0, -1, 0}, skin);
  dem::PrimitiveWall& wall = dem::addWall(model, dem::makeCylinder({}, {0, 0, 1}, drumRadius));
  wall.skin = skin;
  wall.angularVelocity = {0, 0, drumSpeed};
  return model;
}

Spheres repeated(const Spheres& spheres, int copies, double width, int axis) {
  Spheres all;
  for (int c = 0; c < copies; ++c)
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      all.x.push_back(spheres.x[i]);
      all.x.back()[axis] += c * width;
      all.diameter.push_back(spheres.diameter[i]);
      if (spheres.v.empty()) continue;
      all.v.push_back(spheres.v[i]);
      all.omega.push_back(spheres.omega[i]);
    }
  return all;
}

Spheres bigAmongSmall(double edge, int bigOnes, double bigDiameter, unsigned seed) {
  std::mt19937_64 random(seed);
  Spheres spheres;
  const double reach = 0.5 * bigDiameter + 0.505;
  for (int tries = 0; static_cast<int>(spheres.size()) < bigOnes && tries < 2000000; ++tries) {
    const double half = 0.5 * edge;
    const Vec3 at{half + jitter(random, half), half + jitter(random, half), half + jitter(random, half)};
    bool free = true;
    for (const Vec3& other : spheres.x) free = free && periodicDistance(at, other, edge) > bigDiameter + 0.02;
    if (!free) continue;
    spheres.x.push_back(at);
    spheres.diameter.push_back(bigDiameter);
  }
  const std::size_t placed = spheres.size();
  const int n = static_cast<int>(edge);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const Vec3 at{i + 0.5, j + 0.5, k + 0.5};
        bool free = true;
        for (std::size_t b = 0; free && b < placed; ++b) free = periodicDistance(at, spheres.x[b], edge) > reach;
        if (!free) continue;
        spheres.x.push_back(at);
        spheres.diameter.push_back(1.02);
      }
  return spheres;
}

dem::Model waveLattice(int nx, int ny, int nz, double skin) {
  auto model = makeModel(lattice(nx, ny, nz, 1.01), dem::ElasticLaw{{stiffness}},
                         {{{0, 0, 0}, {double(nx), double(ny), double(nz)}}, {true, true, true}}, {}, skin);
  for (std::size_t i = 0; i < model.particles.size(); ++i)
    model.particles.v[i].x = 0.01 * std::sin(2.0 * 3.14159265358979324 * model.particles.x[i].x / nx);
  return model;
}

std::vector<dem::PrimitiveWall> boxOfPlanes(double edge, double skin) {
  std::vector<dem::PrimitiveWall> walls{dem::makePlane({}, {0, 0, 1}), dem::makePlane({}, {1, 0, 0}),
                                        dem::makePlane({edge, 0, 0}, {-1, 0, 0}), dem::makePlane({}, {0, 1, 0}),
                                        dem::makePlane({0, edge, 0}, {0, -1, 0})};
  for (auto& wall : walls) wall.skin = skin;
  return walls;
}

dem::MeshWall boxOfTriangles(double edge, double height, int cells, double skin) {
  std::vector<Vec3> x;
  std::vector<geometry::Facet> facets;
  const double leg = edge / cells;
  const int rows = static_cast<int>(std::round(height / leg));
  const auto face = [&](int n, const auto& at) {
    const int first = static_cast<int>(x.size());
    for (int i = 0; i <= cells; ++i)
      for (int j = 0; j <= n; ++j) x.push_back(at(edge * i / cells, (n == rows ? height : edge) * j / n));
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < n; ++j) {
        const int a = first + i * (n + 1) + j, b = a + n + 1;
        facets.push_back({a, b, b + 1});
        facets.push_back({a, b + 1, a + 1});
      }
  };
  face(cells, [](double s, double t) { return Vec3{s, t, 0}; });
  face(rows, [](double s, double t) { return Vec3{0, s, t}; });
  face(rows, [edge](double s, double t) { return Vec3{edge, s, t}; });
  face(rows, [](double s, double t) { return Vec3{s, 0, t}; });
  face(rows, [edge](double s, double t) { return Vec3{s, edge, t}; });
  dem::MeshWall mesh;
  mesh.wall = dem::makeWall(std::move(x), std::move(facets));
  mesh.candidates.skin = skin;
  return mesh;
}

}  // namespace dovetail::dem_benchmark
