#include "input/thesis_symbols.hpp"

namespace gaussdrift::input {

const std::vector<ThesisSymbol>& thesis_symbols() {
  static constexpr std::string_view sum = "docs/fgtd.md: s_alpha(y) = D^alpha sum_j lambda_j exp(-sigma |y - x_j|^2)";
  static constexpr std::string_view boxes = "docs/fgtd.md, the boxes of the method `hermite`";
  static constexpr std::string_view series = "docs/fgtd.md, the series of the method `hermite`";
  static constexpr std::string_view particles = "docs/method.md, section 2";
  static constexpr std::string_view fields = "`[velocity] gaussians`; docs/method.md, section 9";
  static constexpr std::string_view timing = "`gaussdrift reproduce fgtd` measures it again";
  static const std::vector<ThesisSymbol> list = {
      {"A", "A.1", "numbers of the boxes whose sources are summed for a target", boxes},
      {"A_beta", "A.1", "moment beta of a box: the coefficient of its Hermite series", series},
      {"B_I", "A.1", "the box that is made of the boxes with numbers in I", boxes},
      {"B_i", "A.1", "box number i of the bounding box B, with the indices i_1 .. i_d", boxes},
      {"c", "A.1", "centre of a box B_i", boxes},
      {"d", "A.1", "dimension of space", sum},
      {"HI", "A.1", "upper corner of the bounding box B", boxes},
      {"hi", "A.1", "upper corner of the box B_i", boxes},
      {"LO", "A.1", "lower corner of the bounding box B", boxes},
      {"lo", "A.1", "lower corner of the box B_i", boxes},
      {"M", "A.1", "number of targets", "the points of `evaluate.per_axis`; `gaussdrift sum --targets`"},
      {"m", "A.1", "number of boxes", "told with the method by `check` and `sum`; only occupied boxes exist here"},
      {"N", "A.1", "number of sources", "the particles that carry weight; `gaussdrift sum --sources`"},
      {"N_i", "A.1", "number of sources in the box B_i", boxes},
      {"n", "A.1", "number of neighbouring boxes to each side, on each axis, that count",
       "`evaluate.n`; `gaussdrift sum --n`"},
      {"n_c", "A.1", "number of neighbouring boxes that are summed, (2n+1)^d at most", boxes},
      {"n_d", "A.1", "number of boxes of the bounding box on each axis", boxes},
      {"nn", "A.1", "list of the numbers of neighbouring boxes", boxes},
      {"p", "A.1", "where the series ends: its number of terms on each axis", "`evaluate.p`; `gaussdrift sum --p`"},
      {"Q", "A.1", "sum of |lambda_j|", "told as Q by `gaussdrift sum`; docs/fgtd.md, the promise"},
      {"Q_I", "A.1", "sum of |lambda_j| over the sources in B_I", "docs/fgtd.md, the promise"},
      {"R", "A.1", "numbers of the boxes whose sources are left out", boxes},
      {"r", "A.1", "in (0, 1): sets the side of a box and the error", "`evaluate.r`; `gaussdrift sum --r`"},
      {"tilde{r}", "A.1", "side of a box, r sqrt(2/sigma)", "told as side by `check` and `sum`"},
      {"x_j", "A.1", "source j", sum},
      {"y", "A.1", "target", sum},
      {"alpha", "A.1", "multi-index of the derivative of the Gaussian",
       "`gaussdrift sum --derivative`. The array alpha of particle files is another: alpha_j"},
      {"beta", "A.1", "multi-index of a term of the series", series},
      {"lambda_j", "A.1", "weight j", sum},
      {"nu", "A.1", "number of parts into which the unit cube is divided on each axis", boxes},
      {"sigma", "A.1", "sharpness of the Gaussian", "`gaussdrift sum --sigma`; in a scene 1 / eps^2"},
      {"bf", "A.2", "the sum over all pairs (algorithm 3.8)", "the method `direct`"},
      {"be_a", "A.2", "number of points from which the fast method is cheaper, by the cost formula", timing},
      {"be_n", "A.2", "number of points from which the fast method is cheaper, measured", timing},
      {"e_a", "A.2", "absolute error", "measured in every run and every `sum`, against all pairs at a sample"},
      {"e_r", "A.2", "relative error", "measured in every run and every `sum`, against all pairs at a sample"},
      {"fgtd", "A.2", "fgtd_prepare and fgtd_eval together", "the library fgtd: docs/fgtd.md"},
      {"fgtd_prepare", "A.2", "algorithm 3.6: boxes and moments",
       "the constructor of fgtd::Plan; its seconds are told as prepare"},
      {"fgtd_eval", "A.2", "algorithm 3.7: the series at the targets",
       "fgtd::Plan::evaluate(); its seconds are told as evaluate"},
      {"G", "A.2", "speed-up: seconds of all pairs by those of the fast method", timing},
      {"c", "A.3", "factor of the width of a blob, greater than 1", "`particles.overlap`"},
      {"h", "A.3", "spacing of the particles' lattice", "follows from `particles.per_axis` and the domain"},
      {"j", "A.3", "multi-index of a particle on its lattice", particles},
      {"n_g", "A.3", "divisions of the particles' lattice on each axis", "`particles.per_axis`"},
      {"n_ge", "A.3", "divisions of the evaluation lattice on each axis", "`evaluate.per_axis`"},
      {"t", "A.3", "time, from 0 to T", "t in expressions; `output.times`"},
      {"X(t)", "A.3", "path of a particle", particles},
      {"x_j", "A.3", "place where particle j starts", particles},
      {"u", "A.3", "velocity", "`[velocity]`"},
      {"u_0", "A.3", "velocity of the rotating cone", "`field = \"rotation\"`; cases/rotating_cone.toml"},
      {"alpha_j(t)", "A.3", "weight of particle j at the time t", "alpha_j; effects may change it"},
      {"eps", "A.3", "width of a blob", "eps = c h: `particles.overlap`, `particles.per_axis`"},
      {"zeta", "A.3", "smoothing function", "`particles.cutoff`"},
      {"zeta_eps", "A.3", "blob", "`particles.cutoff` of the width eps"},
      {"rho", "A.3", "density", "rho in files, pictures and `[[check]]`"},
      {"rho_0", "A.3", "density at the time 0", "`[density]`"},
      {"rho_eps^h", "A.3", "the density that a run computes", "rho in files, pictures and `[[check]]`"},
      {"Omega", "A.3", "the domain", "`[domain]`"},
      {"G", "A.4", "speed-up: seconds of all pairs by those of the fast method",
       "`gaussdrift reproduce divergence` measures it again"},
      {"M", "A.4", "number of evaluations", fields},
      {"N", "A.4", "number of sources", fields},
      {"S", "A.4", "divergence-free field that interpolates", fields},
      {"u", "A.4", "divergence-free velocity", "`[velocity] gaussians`, `kind = \"velocity\"`"},
      {"x_j", "A.4", "source j", fields},
      {"y", "A.4", "target", fields},
      {"Gamma_j", "A.4", "weight j, a vector", "`[velocity] gaussians`, `kind = \"coefficients\"`"},
      {"omega", "A.4", "vorticity, the curl of the velocity", "docs/method.md, section 9; `kind = \"vorticity\"`"},
  };
  return list;
}

}  // namespace gaussdrift::input
