// Small scenes for the tests of effects: a case as text, run to its end.
#pragma once

#include <string>
#include <vector>

#include "case_text.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"

namespace gaussdrift {

/// A Gaussian of radius 0.2 (variance 0.02 an axis) at the origin of [-1, 1]^2, at rest.
inline const CaseTables resting{.velocity = at_rest,
                                .density = shape_of("gaussian", "0, 0", "0.2"),
                                .particles = "per_axis = 41",
                                .time = "end = 0.5\nstep = 0.1",
                                .evaluate = "per_axis = 33"};
inline const std::string resting_gaussian = case_text(resting);

inline Case scene_of(const std::vector<std::string>& overrides, const std::string& text = resting_gaussian) {
  return gaussdrift::parse_case(text, "scene.toml", overrides).spec;
}

/// The particles at the end.
inline Particles particles_at_end(const Case& spec, int threads = 0) {
  Simulation simulation(spec, threads);
  simulation.run();
  return simulation.particles();
}

/// Moments of the weights: mass, centroid and covariance (of the particles; the blobs add their own variance).
struct Moments {
  double mass = 0;
  Vector centroid{};
  double xx = 0, xy = 0, yy = 0;
};

inline Moments moments_of(const Particles& particles) {
  Moments m;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    m.mass += particles.alpha[j];
    for (int k = 0; k < particles.dimension; ++k) m.centroid[k] += particles.alpha[j] * particles.position[k][j];
  }
  for (int k = 0; k < particles.dimension; ++k) m.centroid[k] /= m.mass;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    const double dx = particles.position[0][j] - m.centroid[0], dy = particles.position[1][j] - m.centroid[1];
    m.xx += particles.alpha[j] * dx * dx / m.mass;
    m.xy += particles.alpha[j] * dx * dy / m.mass;
    m.yy += particles.alpha[j] * dy * dy / m.mass;
  }
  return m;
}

/// Some overrides and more of them.
inline std::vector<std::string> with(std::vector<std::string> some, const std::vector<std::string>& more) {
  some.insert(some.end(), more.begin(), more.end());
  return some;
}

inline std::string edges(const std::string& list) { return "domain.edges=[" + list + "]"; }

}  // namespace gaussdrift
