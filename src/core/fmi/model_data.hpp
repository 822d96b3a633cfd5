// Snow, runners, bodies and steps as named numbers, and back: both have the same bits.
#pragma once

#include "dynamics/dynamics.hpp"
#include "support/fields.hpp"

namespace skisnow {

void put_snow(const Snow& snow, Fields& out);  // but for the tracks in it
std::shared_ptr<Snow> snow_of(const Fields& data);

void put_runners(const std::vector<Runner>& runners, double spacing, Fields& out);
std::vector<Runner> runners_of(const Fields& data);

void put_body(const Body& body, Fields& out);
Body body_of(const Fields& data);

void put_rule(const StepRule& rule, Fields& out);
StepRule rule_of(const Fields& data);

}  // namespace skisnow
