// Depth and forces of the snow along a ski, brought from the lines to the nodes of its beam.
#pragma once

#include <algorithm>
#include <vector>

#include "contact/sections.hpp"

namespace skisnow {

struct Along {
  std::vector<double> depth, force, shear;  // depth of the deeper edge (m); forces per length of ski (N/m)
  double push[3] = {};                      // sums along the edge, of friction across it and off the surface (N)
};

// [observe] Sections go to the two nodes beside them in proportion, their sum is kept; depths are interpolated.
inline Along along_nodes(const Runner& runner, const Sections& s) {
  const int last = runner.nodes() - 1;
  const auto nodes = std::size_t(last + 1);
  Along out{std::vector<double>(nodes), std::vector<double>(nodes), std::vector<double>(nodes), {}};
  const auto& node = runner.node;
  int e = last - 1, at = last, before = -1;
  for (int i = 0; i < s.count(); i++) {  // from the tail
    if (!(s[SHARE][i] > 0.0)) continue;
    for (int a = 0; a < 3; a++) out.push[a] += s[ForceField(PUSH + a)][i];
    const double here = s[STATION][i], depth = s[DEEPEST][i];
    while (e > 0 && here > node[std::size_t(e)]) e--;
    const auto front = std::size_t(e), rear = front + 1;
    const double z = std::clamp((node[front] - here) / (node[front] - node[rear]), 0.0, 1.0);
    out.force[front] += (1.0 - z) * s[FORCE][i], out.force[rear] += z * s[FORCE][i];
    out.shear[front] += (1.0 - z) * s[SHEAR][i], out.shear[rear] += z * s[SHEAR][i];
    for (; at >= 0 && node[std::size_t(at)] <= here; at--) {
      const double from = before < 0 ? here : s[STATION][before], way = here - from;
      const double f = way > 0.0 && node[std::size_t(at)] > from ? (node[std::size_t(at)] - from) / way : 0.0;
      out.depth[std::size_t(at)] = before < 0 ? depth : f * depth + (1.0 - f) * s[DEEPEST][before];
    }
    before = i;
  }
  for (; at >= 0 && before >= 0; at--) out.depth[std::size_t(at)] = s[DEEPEST][before];
  for (std::size_t j = 0; j < nodes; j++) {
    const double ahead = j > 0 ? node[j - 1] - node[j] : 0.0, behind = j + 1 < nodes ? node[j] - node[j + 1] : 0.0;
    out.force[j] /= 0.5 * (ahead + behind);
    out.shear[j] /= 0.5 * (ahead + behind);
  }
  return out;
}

}  // namespace skisnow
