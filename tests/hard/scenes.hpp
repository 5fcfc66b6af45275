// Scenes and sums that the hard cases share.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "case_text.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"
#include "sim/scene.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {

inline Case built_in(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return gaussdrift::read_case(std::string(SOURCE_DIR) + "/cases/" + name + ".toml", overrides).spec;
}

inline Case written(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return gaussdrift::parse_case(text, "scene.toml", overrides).spec;
}

/// What a run leaves: numbers of its outputs, particles at its end.
struct Ran {
  RunSummary summary;
  Particles particles;
  const FrameNumbers& last() const { return summary.frames.back().second; }
};

inline Ran run(const Case& scene, int threads = 0) {
  Simulation simulation(scene, threads);
  Ran ran;
  ran.summary = simulation.run();
  ran.particles = simulation.particles();
  return ran;
}

/// The density of the particles at one point, every blob summed.
inline double density_at(const Case& scene, const Particles& particles, double x, double y) {
  const Scene parts = make_scene(scene);
  return sum_blobs(particles, parts.cutoff, {2, 1, {&x, &y, nullptr}}, 1)[0];
}

}  // namespace gaussdrift
