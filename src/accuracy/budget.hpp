// Where the error of a run comes from: time stepping, smoothing, quadrature, Gauss transform, each told by changing its
// cause alone. Predicted from a case before it runs, measured after it. method.md, section 10.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/state_bytes.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/simulation.hpp"
#include "sim/scene.hpp"

namespace gaussdrift::accuracy {

/// All errors are of the last output, in the largest norm and relative to max |rho| of the exact density there.
struct Budget {
  double time_stepping = 0;  // what the paths' steps do to the density
  double smoothing = 0;      // blobs of this width in place of points
  double quadrature = 0;     // a sum over lattice points in place of an integral
  double transform = 0;      // predicted: what is allowed; measured: on a sample against the direct sum
  double left_out = 0;       // what the blobs of all points below particles.threshold can make together, at most
  double fit = 0;            // what samples leave open that density or velocity are fitted to; 0 without such
  double total = 0;
  double interpolation = 0;  // of data of a velocity on a grid: what they miss, which is not in the total; 0: none
  double noise = 0;          // what chance does in a random walk; 0: there is none
  double others = 0;         // with such noise: what else there is of the total, where that is known
  bool only_some = false;    // with such noise: time stepping, smoothing and quadrature are not told apart
  std::string dominates;     // "smoothing", ...
  std::vector<std::string> advice;  // what could be saved, what would help
  std::size_t probes = 0;           // points at which the causes were told apart
  double outside = 0;               // part of sum |alpha_j| outside the domain at the last output
  std::size_t particles = 0;        // at the start, of a prediction
  double lowest = 0, highest = 0;   // of the density at the last output, predicted
  std::string not_covered;          // why there are no numbers; empty: there are
  bool too_dear = false;            // they would have taken more work than was allowed

  bool known() const { return not_covered.empty(); }
};

/// To bytes and from bytes, all but `fit`, and what belongs to noise.
void pass(base::StateBytes& bytes, Budget& budget);
void pass_noise(base::StateBytes& bytes, Budget& budget);

/// Why a case has no budget: effects that move weight between particles, ...; empty if it has one.
std::string budget_not_covered(const Case& spec);

/// How much work may be spent on it.
enum class Effort {
  whatever,      // it takes
  share_of_run,  // measured: 9 % of the work of the run, predicted: 5 %, or a tenth of a second; else not covered
};

/// The work that all predictions together may take, and what they have taken. It is estimated beforehand in the units
/// of Work (sim/work.hpp), so that decisions do not depend on the machine.
struct Allowance {
  double work = std::numeric_limits<double>::infinity();
  double spent = 0;

  double left() const { return work - spent; }
};

/// Which causes: those of the lattice and the blobs alone, or the steps as well.
enum class Causes { lattice, all };

/// Before the run. Paths are followed at 1e-8, exact densities are taken at some thousand grid points. Steps are tried
/// with a sample of the particles, or with longer steps whose error is scaled back by the method's order.
Budget predict_budget(const Case& spec, const Scene& scene, Effort effort, int threads, Causes causes = Causes::all);

/// The same for at most what is left of the allowance, else Budget::too_dear.
Budget predict_budget(const Case& spec, const Scene& scene, Allowance& allowance, int threads,
                      Causes causes = Causes::all);

/// Keeps what measure_budget() needs: the last output of a run.
class LastFrame : public Observer {
 public:
  struct Kept {
    bool any = false;
    double time = 0;  // elapsed
    Particles particles;
    DensityGrid density;
    std::optional<std::vector<double>> exact;  // on the grid, if the run had it there
    FrameNumbers numbers;
  };
  LastFrame(Kept& kept, double last_time) : kept_(kept), last_(last_time) {}
  std::string name() const override { return "error budget"; }
  bool needs_particles(double elapsed) const override { return elapsed == last_; }
  void frame(const Frame& frame) override;

 private:
  Kept& kept_;
  double last_;
};

/// After the run, at the points with the largest errors; how many follows from what the run cost.
Budget measure_budget(const Case& spec, const Scene& scene, const LastFrame::Kept& last, Effort effort, int threads);

/// Does an effect of the case move particles by chance? Then its budget has the noise of that, whatever else is not covered.
bool moves_by_chance(const Case& spec);

/// The causes that are told of it, by their names; those that most cases lack only where they are not 0.
std::vector<std::pair<double, std::string>> told_causes(const Budget& budget);
/// A line a cause, the dominating one marked, and the advice.
std::string to_text(const Budget& budget);
/// {"time_stepping", "smoothing", "quadrature", "transform", "left_out", "total", "dominates"}, with samples "fit" too; of a random
/// walk {"noise", "others", "transform", ...}; or {"not_covered"}.
nlohmann::ordered_json to_json(const Budget& budget);

}  // namespace gaussdrift::accuracy
