#include "effect/reaction.hpp"

#include <fmt/format.h>

#include <cmath>

#include "effect/catalogue.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

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
}

namespace {

constexpr std::string_view nothing_enters =
    "all mass is there at the start, in [density]; [effects.reaction] lets it decay, or grow with a negative rate";

}  // namespace

namespace named {

NamedEffect reaction() {
  return {
      .about =
          NamedFormula{.name = "reaction",
                       .meaning = "the weights of the particles decay or grow along their paths: alpha' = -rate alpha. "
                                  "The density then obeys d_t rho + div(rho u) + rate rho = 0",
                       .parameters = {{.name = "rate",
                                       .kind = NamedParameter::Kind::expression_in_time,
                                       .unit = "1 / time",
                                       .symbol = "u_0",
                                       .meaning = "rate of decay, an expression in x, y, z, t and params; weights grow "
                                                  "where it is negative"}}},
      .traits = {.grows_weights = {.words = "the reaction changes the weights"}},
      .decay_rate = "rate",
      .elsewhere = {{"decay", "[effects.reaction] with its rate"},
                    {"inflow", nothing_enters},
                    {"inlet", nothing_enters},
                    {"source", nothing_enters},
                    {"sources", nothing_enters},
                    {"sink", nothing_enters},
                    {"emission", nothing_enters},
                    {"emissions", nothing_enters}},
      .memory = [](const EffectSpec&, int) { return EffectMemory{.integrals = 1}; },
      .make = [](const EffectSpec&, const EffectScene& scene) { return std::make_unique<Reaction>(*scene.decay); }};
}

}  // namespace named

}  // namespace gaussdrift
