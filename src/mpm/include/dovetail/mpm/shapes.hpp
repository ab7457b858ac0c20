// Weights of grid nodes at material points.
#pragma once

#include <array>

namespace dovetail::mpm {

/// Functions of nodes at distance 1. B-splines (Steffen, Kirby & Berzins 2008, Int. J. Numer. Meth. Engng 76) have
/// continuous gradients. `linear`: as bricks, whose gradients jump where a point passes into the next cell. `gimp`:
/// linear ones averaged over a box that the point keeps (uGIMP; Bardenhagen & Kober 2004, CMES 5).
enum class Shape { linear, gimp, quadratic, cubic };
const char* name(Shape shape);

constexpr int mostInReach = 4;  ///< nodes of an axis

/// Nodes first … first + count − 1 of an axis and their weights at a place s, node i being at s = i. For every s Σ
/// value = 1, Σ slope = 0, Σ i value = s, Σ i slope = 1.
struct LineWeights {
  int first = 0;
  std::array<double, mostInReach> value{}, slope{};  ///< slope = d value/ds
};

/// Nodes of an axis that a point reaches, those with the weight 0 included.
int reachOf(Shape shape);
/// @param half  of the box of `gimp`, over the distance of nodes, > 0 and at most ½
LineWeights weightsAt(Shape shape, double s, double half = 0.25);

/// Weights at s of the nodes that s0 reaches: the polynomials that their functions are at s0 go on to s (of `gimp`, the
/// tangents). The sums above hold.
LineWeights weightsBeside(Shape shape, double s, double s0, double half = 0.25);

/// Σ value (i − s)², the same for every s, of B-splines: ¼ (quadratic), ⅓ (cubic); 0 of the others, for which it
/// depends on s.
double secondMoment(Shape shape);

}  // namespace dovetail::mpm
