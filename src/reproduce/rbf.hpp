// Sums of radial kernels by Gaussians, beside all pairs: the kernels of Roussos and Baxter [RB05], and every other one that
// the library rbf knows. The paper's own times are of another machine; here are errors, promises and ratios.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace gaussdrift::reproduce {

struct RbfOptions {
  int points = 20000;       // centres, and as many targets
  double tolerance = 1e-6;  // of the sums
  int threads = 1;
};

/// Errors are the largest at some targets, relative to the largest kernel value (slope) times the weights: the measure
/// of the promise.
struct RbfSum {
  std::string kernel;
  bool in_paper = false;
  int dimension = 0;
  double shape = 0;           // 0: takes none
  std::size_t gaussians = 0;  // that stand for the kernel
  double near = 0;            // closer pairs are summed one by one
  double kernel_error = 0;    // of the Gaussians alone
  double bound = 0;           // what is promised, at most the tolerance
  double error = 0;
  double gradient_error = 0;
  double seconds = 0, direct_seconds = 0;  // plan and evaluation
  double ratio() const { return direct_seconds / seconds; }
};

/// How many Gaussians stand for a kernel of shape 0.3 on the diagonal of the unit square.
struct RbfTerms {
  std::string kernel;
  std::vector<std::size_t> gaussians{};  // one for each of RbfReproduction::accuracies
};

/// The multiquadric of shape 0.3 in the plane.
struct RbfGrowth {
  int points = 0;
  double seconds = 0, direct_seconds = 0;
};

struct RbfReproduction {
  RbfOptions options;
  std::vector<double> accuracies{};
  std::vector<RbfTerms> terms{};
  std::vector<RbfSum> sums{};
  std::vector<RbfGrowth> growth{};
  double seconds = 0;

  /// Every sum and every gradient kept its promise.
  bool kept() const;
};

RbfReproduction reproduce_rbf(const RbfOptions& options, const std::function<void(const std::string&)>& progress = {});

std::string to_text(const RbfReproduction& result);
std::string to_json(const RbfReproduction& result);

}  // namespace gaussdrift::reproduce
