#include "reference/beam_case.hpp"

#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::cantilever {

double beamParticleMass(const BeamCase& beam) {
  const double r = beam.particleRadius;
  return 4.0 / 3.0 * std::numbers::pi * r * r * r * beam.particleDensity;
}

double totalWeight(const BeamCase& beam) { return beam.particles * beamParticleMass(beam) * beam.gravity; }

double startHeight(const BeamCase& beam) {
  return beam.height / 2.0 + beam.particleRadius - beamParticleMass(beam) * beam.gravity / beam.contactStiffness;
}

Section makeSection(const BeamCase& beam) {
  for (const auto& [value, field] : {std::pair{beam.length, "length"},
                                     {beam.width, "width"},
                                     {beam.height, "height"},
                                     {beam.youngsModulus, "youngsModulus"},
                                     {beam.shearCorrection, "shearCorrection"},
                                     {beam.density, "density"},
                                     {beam.bendingFactor, "bendingFactor"},
                                     {beam.particleRadius, "particleRadius"},
                                     {beam.particleDensity, "particleDensity"},
                                     {beam.contactStiffness, "contactStiffness"}})
    requirePositive(value, field);
  if (!(beam.poissonRatio > -1.0 && beam.poissonRatio < 0.5))
    throw InputError("Poisson's ratio is outside (-1, 0.5)", "poissonRatio", "give a value of an isotropic solid");
  if (beam.particles < 1) throw InputError("no particle slides", "particles", "give at least one");
  const double area = beam.width * beam.height;
  const double secondMoment = area * beam.height * beam.height / 12.0;
  const double shearModulus = beam.youngsModulus / (2.0 * (1.0 + beam.poissonRatio));
  return {.bending = beam.bendingFactor * beam.youngsModulus * secondMoment,
          .shear = beam.shearCorrection * shearModulus * area,
          .mass = beam.density * area,
          .rotaryMass = beam.density * secondMoment};
}

}  // namespace dovetail::cantilever
