// Loads, damping and supports as terms of a model.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/fem/model/term.hpp"
#include "dovetail/fem/model/time_functions.hpp"

namespace dovetail::fem {

/// f = m g with the row sums m of the mass matrix in use (of the consistent one in statics), so that a free body falls
/// without stress. Stored energy −Σ m g · (X + u), J.
/// @param g  m/s²
/// @throws InputError if g is not finite; at its first use if the model has no masses (addMass)
std::shared_ptr<Term> gravity(Vec3 g, std::string name = "gravity");
/// The same with g(t), m/s² (a shaken ground); its work is booked.
std::shared_ptr<Term> gravity(std::function<Vec3(double)> g, std::string name = "gravity");

/// scale(t) · force on each node of the set. A constant scale stores −Σ f · u, J; else the work is booked.
/// @param force  on each node, N
/// @throws InputError for an empty set, a negative node number or a force that is not finite; at its first use for a
/// node that the model does not have
std::shared_ptr<Term> nodalForce(std::span<const int> nodes, Vec3 force, Amplitude scale = 1.0,
                                 std::string name = "nodal force");

/// A pressure on the reference faces that does not follow them: f = −p ∫ N dA n with reference normal and area.
/// @param p  Pa, positive where it pushes
/// @throws InputError for no faces or a node that the mesh does not have
std::shared_ptr<Term> deadPressure(const SolidMesh& mesh, std::span<const Face> faces, Amplitude p,
                                   std::string name = "dead pressure");
/// The same of a pressure p(X, t), Pa, of reference position, m, and time, s; its work is booked.
std::shared_ptr<Term> deadPressure(const SolidMesh& mesh, std::span<const Face> faces,
                                   std::function<double(const Vec3&, double)> p, std::string name = "dead pressure");
/// A force per reference area that does not follow the faces: f = scale(t) traction ∫ N dA.
/// @param traction  Pa
std::shared_ptr<Term> deadTraction(const SolidMesh& mesh, std::span<const Face> faces, Vec3 traction,
                                   Amplitude scale = 1.0, std::string name = "dead traction");
/// f = ∫ N traction(X, t) dA over the reference faces; its work is booked.
/// @param traction  Pa, of reference position (m) and time (s)
std::shared_ptr<Term> deadTraction(const SolidMesh& mesh, std::span<const Face> faces,
                                   std::function<Vec3(const Vec3&, double)> traction,
                                   std::string name = "dead traction");

/// A pressure normal to the deformed faces: f_a = −p ∫ N_a ∂x/∂ξ × ∂x/∂η dξ dη, integrated exactly, with its exact
/// tangent.
///
/// It derives from a potential, p times the volume behind the faces (of lines: the area times the thickness), if they
/// close a surface or if the nodes on their rim cannot move; only then is the (assembled, constrained) tangent
/// symmetric. The term calls itself symmetric if every node on an edge that belongs to one face only is among
/// `clamped`, and stores p V, J, if p is constant as well; otherwise the work is booked.
/// @param p        Pa, positive where it pushes
/// @param clamped  nodes that are held in all components; in ascending order
std::shared_ptr<Term> followingPressure(const SolidMesh& mesh, std::span<const Face> faces, Amplitude p,
                                        std::span<const int> clamped = {}, std::string name = "pressure");

/// The same of a pressure p(X, t), Pa, that stays with the material: X is the reference position, m. It has no
/// potential.
std::shared_ptr<Term> followingPressure(const SolidMesh& mesh, std::span<const Face> faces,
                                        std::function<double(const Vec3&, double)> p, std::string name = "pressure");

/// f = −α M v with the mass matrix in use: damping ratio α / (2 ω) of a mode with angular frequency ω. (Damping
/// proportional to the stiffness is viscosity of the material.) No force in statics.
/// @param alpha  1/s, ≥ 0
std::shared_ptr<Term> massDamping(double alpha, std::string name = "mass damping");
/// f = −k u on each node of the set, component by component. Stores ½ k u², J.
/// @param stiffness  per node, N/m, ≥ 0
/// @throws InputError as nodalForce, or for a negative stiffness
std::shared_ptr<Term> groundSprings(std::span<const int> nodes, Vec3 stiffness, std::string name = "ground springs");
/// f = −c v on each node of the set, component by component. No force in statics.
/// @param damping  per node, kg/s, ≥ 0
/// @throws InputError as nodalForce, or for a negative damping
std::shared_ptr<Term> groundDashpots(std::span<const int> nodes, Vec3 damping, std::string name = "ground dashpots");

}  // namespace dovetail::fem
