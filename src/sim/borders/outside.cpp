#include "sim/borders/outside.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/borders/edges.hpp"

namespace gaussdrift {

bool is_outside(const Particles& particles, std::size_t j, const Domain& domain) {
  const double rounding = rounding_of(domain);
  bool inside = true;
  for (int k = 0; k < domain.dimension; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const double x = particles.position[axis][j];
    inside = inside && x >= domain.min[axis] - rounding && x <= domain.max[axis] + rounding;
  }
  return !inside;
}

double part_outside(const Particles& particles, const Domain& domain) {
  double all = 0, outside = 0;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    const double weight = std::abs(particles.alpha[j]);
    all += weight;
    if (is_outside(particles, j, domain)) outside += weight;
  }
  return all > 0 ? outside / all : 0;
}

bool has_left(const FrameNumbers& numbers) {
  return std::any_of(numbers.left.begin(), numbers.left.end(),
                     [](const Departed& departed) { return departed.particles > 0; });
}

std::string why_nothing_is_left(double outside, double weight) {
  if (!(weight > 0)) return "nothing is left to compare (every weight has fallen to 0)";
  if (is_all(outside)) return "nothing is left to compare (all of the mass has left the domain)";
  return "there is nothing to compare (the exact density is 0 on the grid)";
}

std::string percent_text(double part) {
  if (is_all(part)) return "all";
  if (part < 0.5) return fmt::format("{:.2g} %", 100 * part);
  const int decimals = static_cast<int>(std::ceil(-std::log10(100 * (1 - part))));
  return fmt::format("{:.{}f} %", 100 * part, std::clamp(decimals, 0, 9));
}

std::string about_leaving(const std::vector<std::pair<double, FrameNumbers>>& frames) {
  constexpr double noticed = 1e-3;
  const auto first_of_the_last = [&](const auto& holds) {  // the outputs for which it holds up to the end
    auto since = frames.end() - 1;
    while (since != frames.begin() && holds((since - 1)->second)) --since;
    return since->first;
  };
  const auto weightless = [](const FrameNumbers& numbers) { return numbers.weight == 0; };
  // What leaves by open edges is meant to, and is counted.
  if (!frames.empty() && weightless(frames.back().second) && has_left(frames.back().second)) return "";
  if (!frames.empty() && weightless(frames.back().second))
    return fmt::format("every weight has fallen to 0 by t = {:.4g}: outputs from there on are 0; end the run earlier",
                       first_of_the_last(weightless));
  const auto most = std::max_element(frames.begin(), frames.end(),
                                     [](const auto& a, const auto& b) { return a.second.outside < b.second.outside; });
  if (most == frames.end() || most->second.outside < noticed) return "";
  const auto& [end, last] = frames.back();
  if (is_all(last.outside))
    return fmt::format(
        "all of the mass has left the domain by t = {:.4g}: outputs from there on show nothing of it; end the run "
        "earlier, or enlarge the domain",
        first_of_the_last([](const FrameNumbers& numbers) { return is_all(numbers.outside); }));
  std::string text;
  if (last.outside >= noticed)
    text = fmt::format("at t = {:.4g}, {} of the mass is outside the domain", end, percent_text(last.outside));
  if (most->second.outside > last.outside * (1 + 1e-6))
    text += fmt::format("{}at t = {:.4g}, {} of {} was outside", text.empty() ? "" : ", and ", most->first,
                        percent_text(most->second.outside), text.empty() ? "the mass" : "it");
  return text + "; outputs show the density of what is inside";
}

Heaviest heaviest(const Particles& particles, const Lattice& lattice) {
  Heaviest found;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    const double weight = std::abs(particles.alpha[j]);
    found.anywhere = std::max(found.anywhere, weight);
    auto rest = static_cast<std::size_t>(particles.id[j]);
    if (rest >= lattice.size()) continue;  // released
    for (int k = 0; k < particles.dimension; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      const std::size_t i = rest % lattice.points[axis];
      rest /= lattice.points[axis];
      if (i == 0 || i + 1 == lattice.points[axis]) found.at_edge = std::max(found.at_edge, weight);
    }
  }
  return found;
}

double part_beyond(std::optional<double> mass, const Heaviest& heaviest, double carried) {
  if (!mass || *mass == 0) return 0;
  // A sum over lattice points misses the mass of a shape with edges, too.
  constexpr double noticed = 1e-6;
  if (heaviest.at_edge < noticed * heaviest.anywhere) return 0;
  return std::clamp(1 - carried / *mass, 0.0, 1.0);
}

double part_beyond(std::optional<double> mass, const Particles& particles, const Lattice& lattice) {
  return part_beyond(mass, heaviest(particles, lattice),
                     std::accumulate(particles.alpha.begin(), particles.alpha.end(), 0.0));
}

std::string about_beyond(double part) {
  if (part < 0.01) return "";
  return fmt::format(
      "{} of the mass of the initial density lies outside the domain, where no particles start; enlarge the domain, or "
      "move the density",
      percent_text(part));
}

}  // namespace gaussdrift
