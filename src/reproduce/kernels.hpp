// Studies of interpolation and recompression for general kernels: what Boerm's slides state about rates, Melenk's blocks
// recompressed, sums to the promise, orders by level, and functions that several bases take.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace gaussdrift::reproduce {

struct KernelsOptions {
  int points = 10000;    // of the sums
  double finest = 1e-6;  // tolerance; the other one is 1e-3
  int threads = 1;
};

/// Interpolation of 1/r in a cube, seen from a distance: largest error times the distance.
struct KernelsRate {
  double eta = 0;               // diameter / distance
  std::vector<double> error{};  // of degrees 0, 1, ...
  double factor = 0;            // of the error from one degree to the next, in the mean
  double stated = 0;            // eta / (eta + 1)
};

/// One substitute charge in the middle of a cube: largest error of the force.
struct KernelsDecay {
  double diameter = 0, distance = 0;
  double error = 0;
  double constant = 0;  // error distance^3 / diameter
};

/// Melenk's blocks for ln |x - y|, and the same recompressed.
struct KernelsBlocks {
  int degree = 0;
  std::size_t doubles = 0, recompressed = 0;
  double error = 0, recompressed_error = 0;  // Frobenius norm
};

struct KernelsSum {
  std::string kernel;
  int dimension = 0;
  double tolerance = 0;
  double error = 0;      // root mean square at some targets, charges 1, relative to the mean sum
  double measured = 0;   // as the plan has measured it, in units in which tolerance is promised
  double megabytes = 0;  // bases and couplings
  std::size_t rank = 0;  // of the lowest level
  double build_seconds = 0, seconds = 0, direct_seconds = 0;
};

struct KernelsOrders {
  bool variable = true;
  std::size_t points = 0;
  std::vector<int> orders{};  // from the largest clusters to the smallest
  double megabytes = 0, seconds = 0, measured = 0;
};

/// How many functions approximate 1/r in a cube, for charges in another one that is one side away.
struct KernelsBases {
  double error = 0;                                                       // root mean square, relative
  std::size_t tensor = 0, total = 0, harmonic = 0, sphere = 0, best = 0;  // 0: more than were tried
};

struct KernelsReproduction {
  KernelsOptions options;
  std::vector<KernelsRate> rates{};
  std::vector<KernelsDecay> decays{};
  std::vector<KernelsBlocks> blocks{};
  std::vector<KernelsSum> sums{};
  std::vector<KernelsOrders> orders{};
  std::vector<KernelsBases> bases{};
  double seconds = 0;

  /// Every sum kept its promise.
  bool kept() const;
};

KernelsReproduction reproduce_kernels(const KernelsOptions& options,
                                      const std::function<void(const std::string&)>& progress = {});

std::string to_text(const KernelsReproduction& result);
std::string to_json(const KernelsReproduction& result);

}  // namespace gaussdrift::reproduce
