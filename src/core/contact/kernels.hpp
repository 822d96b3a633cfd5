// Sections, pressure and forces over lanes of lines. Compiled once for each instruction set.
//
// Equations: docs/methods/contact.md; the names in brackets there are those of the functions here.
#pragma once

#include "contact/force_kernels.hpp"
#include "contact/line_kernels.hpp"
#include "contact/mark_kernels.hpp"
#include "contact/tangent_kernels.hpp"

namespace skisnow::SKISNOW_LANES {

extern const Kernels SET;

}  // namespace skisnow::SKISNOW_LANES
