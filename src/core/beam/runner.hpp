// A runner in the snow: the shape of a ski's base, its pose, its motion.
#pragma once

#include <vector>

#include "beam/edge_shape.hpp"
#include "support/columns.hpp"
#include "support/vectors.hpp"

namespace skisnow {

// Shape of a base along the ski. Positions along the ski count from the boot, positive ahead (m).
struct Runner {
  double tail = 0.0, tip = 0.0;
  double reach = 0.0;                // greatest half width and height of the base (m)
  int places = 0;                    // number of rows of the table, evenly spaced from tail to tip
  std::vector<double> table;         // (places, 4): half width, its slope, height of the base, its slope
  std::vector<double> node;          // beam nodes, tip to tail; a rigid runner has the two ends
  std::vector<int> element;          // (places,) the beam element of each place of the table
  std::vector<double> element_rows;  // (elements, 4): front node, length, its inverse, number
  EdgeShape edge_shape;
  // From positions that fall from tip to tail, half widths and heights there, and the beam's nodes.
  static Runner of(const std::vector<double>& position, const std::vector<double>& half_width,
                   const std::vector<double>& base_height, std::vector<double> node, const EdgeShape& edge_shape);
  void fill_element_rows();
  double places_per_metre() const { return (places - 1) / (tip - tail); }
  int nodes() const { return int(node.size()); }
};

// Place of the boot and directions of the ski in the slope's axes: columns ahead, left across the base, off the base.
struct Pose {
  Vector3 position{};
  double rotation[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // [slope axis][ski axis]
  std::vector<double> beam;  // (nodes, 3): deflection (m), its slope towards the tail, twist (rad)

  Vector3 axis(int which) const { return {rotation[0][which], rotation[1][which], rotation[2][which]}; }
};

// Velocity of the boot and angular velocity, in the slope's axes; rates of the beam.
struct Motion {
  Vector3 velocity{}, turning{};
  std::vector<double> beam;
};

// The pose a share (0 to 1) of the way from one to another, in a time dt (s) at a steady acceleration. If no motion at
// the end is given, at a steady rate of rotation and along the arc that goes with it.
void interpolate(const Pose& from, const Pose& to, const Motion* at_end, double dt, double share, Pose& middle);

void rotation_matrix(const Vector3& v, double (&out)[3][3]);  // from a rotation vector

}  // namespace skisnow
