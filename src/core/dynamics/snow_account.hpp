// Energy that skis have lost to the snow, apart from what the snow can give back.
#pragma once

#include <algorithm>

namespace skisnow {

// Energy that the snow can give back (J): in its pressure, in the shear at the edges, in the friction of a base that
// sticks, and in its delayed depth; and all that the delayed depth has taken so far.
struct SnowStore {
  double pressure = 0.0, shear = 0.0, friction = 0.0, delayed = 0.0, delayed_taken = 0.0;

  static constexpr double SnowStore::* PARTS[] = {&SnowStore::pressure, &SnowStore::shear, &SnowStore::friction,
                                                  &SnowStore::delayed, &SnowStore::delayed_taken};
};

// An account (J) that never falls. `open` is what is not entered in it: above 0 a loss that may be the error of a step,
// below 0 what the account would have fallen by. Later losses pay that back first.
struct Loss {
  double total = 0.0, open = 0.0;

  // Part of the losses so far that exceeds a band of errors and is to be entered.
  double due(double loss, double band) {
    open += loss;
    const double out = std::max(open - band, 0.0);
    open -= out;
    return out;
  }
  double owed() const { return std::max(-open, 0.0); }
};

// The forces on a ski do not pay each account separately: sideways motion presses snow at no cost but the shear
// strength, and an edge that is pressed deeper stores more energy in its shear. If one account owes more than a share
// of the stored energy of the snow, the others' losses of the same step pay for it, the shear first.
struct SnowAccount {
  Loss penetration, shear, rate, friction;

  void add(double by_penetration, double by_shear, double by_rate, double stored) {
    const double band = BAND * stored;
    Loss* const accounts[] = {&shear, &penetration, &rate};
    double due[] = {shear.due(by_shear, band), penetration.due(by_penetration, band), rate.due(by_rate, band)};
    for (Loss* each : accounts)
      for (double& payer : due) {
        const double paid = std::min(payer, std::max(each->owed() - LEFT_OWED * stored, 0.0));
        payer -= paid, each->open += paid;
      }
    for (int i = 0; i < 3; i++) accounts[i]->total += due[i];
  }

  void add_friction(double loss) { friction.total += friction.due(loss, 0.0); }

  // Energy that the snow gave beyond the energy that it had stored (J).
  double owed() const { return penetration.owed() + shear.owed() + rate.owed(); }

 private:
  static constexpr double BAND = 1e-3, LEFT_OWED = 0.1;  // shares of the energy that the snow stores
};

}  // namespace skisnow
