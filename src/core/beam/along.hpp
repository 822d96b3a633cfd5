// Depth and forces of the snow along a ski, brought from the lines to the nodes of its beam.
#pragma once

#include <vector>

#include "contact/sections.hpp"

namespace skisnow {

struct Along {
  std::vector<double> depth, force, shear;  // depth of the deeper edge (m); forces per length of ski (N/m)
  double push[3] = {};                      // sums along the edge, of friction across it and off the surface (N)
};

Along along_nodes(const Runner& runner, const Sections& sections);

}  // namespace skisnow
