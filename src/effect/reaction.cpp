// Reaction, d_t rho + div(rho u) + u0 rho = 0: along the path of a particle alpha' = -u0(X, t) alpha, so that
// alpha(t) = alpha(0) exp(-integral of u0). The integral is a quadrature over the stages of the path and the
// exponential is taken of the sum: a weight keeps its sign and cannot overshoot, however large u0. docs/method.md,
// section 8.1.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <string_view>

#include "effect/catalogue.hpp"
#include "effect/effect.hpp"
#include "field/scalar.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {
namespace {

class Reaction : public Effect, private PlainIntegral {
 public:
  /// The rate u0 must outlive the effect.
  explicit Reaction(const ScalarField& rate) : rate_(rate) {}

  std::string name() const override { return "reaction"; }
  std::string describe() const override { return "reaction alpha' = -(" + rate_.describe() + ") alpha"; }
  Changes changes() const override { return {.weight = true}; }
  std::string conserves() const override { return "the sign of every weight"; }

  const PathIntegral* path_integral() const override { return this; }
  /// Throws NumericalError where a weight is too large for a number.
  void settle(Particles& particles, const double* integral, double time) override;

 private:
  void add_rate(double t, const PointsView& x, double* rate) const override { rate_.add(t, x, rate); }
  std::string quantity() const override { return "the rate of [effects.reaction]"; }

  const ScalarField& rate_;
};

void Reaction::settle(Particles& particles, const double* integral, double time) {
  for (std::size_t j = 0; j < particles.size(); ++j) {
    const double before = particles.alpha[j];
    if (before == 0) continue;  // stays 0 even where exp() overflows
    const double after = before * std::exp(-integral[j]);
    if (!std::isfinite(after)) {
      std::string place;
      for (int k = 0; k < particles.dimension; ++k)
        place += fmt::format("{}{:.6g}", k ? ", " : "", particles.position[k][j]);
      throw NumericalError(
          fmt::format("reaction has made the weight of particle {} too large for a number by t = {:.6g}, at ({}). The "
                      "weight grew by exp({:.4g}), because the rate of [effects.reaction] is negative there. Bring the "
                      "rate nearer to 0, or shorten time.end.",
                      particles.id[j], time, place, -integral[j]));
    }
    particles.alpha[j] = after;
  }
  for (auto& tracer : particles.tracers)
    for (std::size_t j = 0; j < tracer.size(); ++j)
      if (tracer[j] != 0) tracer[j] *= std::exp(-integral[j]);
  add_up_tracers(particles);
}

constexpr std::string_view what_enters =
    "[[source]] releases mass during the run; [effects.reaction] lets it decay, or grow with a negative rate";

std::vector<Complaint> problems(const EffectSpec& effect, const Case&) {
  if (effect.has("rate") || effect.has("half_life")) return {};
  return {{"rate", "has neither \"rate\" nor \"half_life\"", "give one of them: rate = 0.5, or half_life = 3"}};
}

}  // namespace

namespace named {

NamedEffect reaction() {
  return {.about =
              NamedFormula{
                  .name = "reaction",
                  .meaning = "the weights of the particles decay or grow along their paths: alpha' = -rate alpha. "
                             "The density then obeys d_t rho + div(rho u) + rate rho = 0",
                  .parameters = {{.name = "rate",
                                  .kind = NamedParameter::Kind::expression_in_time,
                                  .unit = "1 / time",
                                  .symbol = "u_0",
                                  .meaning = "rate of decay, an expression in x, y, z, t and params; weights grow "
                                             "where it is negative",
                                  .optional = true,
                                  .replaced_by = "half_life"},
                                 {.name = "half_life",
                                  .range = positive,
                                  .unit = "time",
                                  .meaning = "in place of `rate`: the time in which half of every weight decays, so "
                                             "that the rate is ln 2 / half_life everywhere",
                                  .optional = true}}},
          .traits = {.grows_weights = {.words = "the reaction changes the weights"}},
          .decay_rate = "rate",
          .half_life = "half_life",
          .elsewhere = {{"decay", "[effects.reaction] with its rate"},
                        {"inflow", what_enters},
                        {"inlet", what_enters},
                        {"sink", what_enters},
                        {"emission", what_enters},
                        {"emissions", what_enters}},
          .problems = problems,
          .memory = [](const EffectSpec&, int) { return EffectMemory{.integrals = 1}; },
          .make = [](const EffectSpec&, const EffectScene& scene) { return std::make_unique<Reaction>(*scene.decay); }};
}

}  // namespace named

}  // namespace gaussdrift
