// Land in a scene: points without values of the velocities that are data on a grid. docs/method.md, section 14.
#pragma once

#include <optional>
#include <vector>

#include "base/folding.hpp"
#include "field/clocked/clocked.hpp"
#include "field/gridded/land.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/particles.hpp"
#include "sim/borders/departures.hpp"

namespace gaussdrift {

class Coast {
 public:
  explicit Coast(const Case& spec);

  /// False: the data of the case have no land.
  bool exists() const { return !lands_.empty(); }
  AtCoast rule() const { return rule_; }

  bool is_land(double t, const Vector& x) const { return shore(t, x).water < Land::least_water; }

  /// The two sides of a coast, closer together than rounding of what is known of it.
  struct Crossing {
    Vector water{}, land{};
  };
  /// Where the straight way from a to b first comes to land, if it does: it is looked at twice a cell of the data at least.
  /// Both are `a` where that is on land.
  std::optional<Crossing> crossing(double from, const Vector& a, double to, const Vector& b) const;

  /// Does what the rule says with particles that have gone from positions `began` to where they are. Those that stop or
  /// will be removed lie on land then, and so does nobody else but who started there. The same for any number of threads.
  void meet(const std::array<std::vector<double>, max_dimension>& began, Particles& particles, double from, double to,
            int threads) const;

  /// Takes back moves by chance that come to land from water. As likely as one way is the other, so that nothing gathers
  /// at the coast. The same for any number of threads.
  void keep_off(const std::array<std::vector<double>, max_dimension>& before, Particles& particles, double from,
                double to, int threads) const;

 private:
  template <class Place>
  void place_each(const std::array<std::vector<double>, max_dimension>& began, Particles& particles, int threads,
                  const Place& place) const;
  Land::Shore shore(double t, const Vector& x) const;  // of the land that is most there; in unfolded space
  Vector met(const Vector& a, const Vector& b, double from, double to) const;
  std::optional<Vector> out_of_land(double t, Vector x) const;

  std::vector<Land> lands_;
  AtCoast rule_;
  Clock clock_;
  Folding folding_;
  int dimension_;
  Vector spacing_{};  // of the finest data with land
};

/// Particles on land leave the run where the coast removes them.
class CoastTakes : public WayOut {
 public:
  explicit CoastTakes(const Case& spec) : coast_(spec) {}
  std::vector<std::string> reasons() const override { return {"coast"}; }
  void mark(const Particles& particles, double time, std::vector<int>& reason) const override;

 private:
  Coast coast_;
};

}  // namespace gaussdrift
