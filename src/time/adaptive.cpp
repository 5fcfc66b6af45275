#include "time/adaptive.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gaussdrift::time {

namespace {

constexpr int stages = 12;

// Weights of the error estimates of order 5, and those of order 3 as differences to the weights of order 8.
constexpr std::array<double, stages> error_5{0.1312004499419488073250102996e-01,
                                             0,
                                             0,
                                             0,
                                             0,
                                             -0.1225156446376204440720569753e+01,
                                             -0.4957589496572501915214079952e+00,
                                             0.1664377182454986536961530415e+01,
                                             -0.3503288487499736816886487290e+00,
                                             0.3341791187130174790297318841e+00,
                                             0.8192320648511571246570742613e-01,
                                             -0.2235530786388629525884427845e-01};
constexpr std::array<double, stages> weights_3{
    0.244094488188976377952755905512,    0, 0, 0, 0, 0, 0, 0, 0.733846688281611857341361741547, 0, 0,
    0.220588235294117647058823529412e-01};

bool all_finite(const std::vector<double>& values) {
  double sum = 0;  // anything not finite makes it so
  for (const double value : values) sum += 0 * value;
  return sum == 0;
}

class Integration {
 public:
  Integration(const BlockRate& rate, std::size_t points, const AdaptiveOptions& options, double* state)
      : rate_(rate),
        points_(points),
        length_(points * options.components.size()),
        options_(options),
        y_(state),
        stage_(length_),
        next_(length_),
        first_rate_(length_),
        next_rate_(length_) {
    for (auto& k : k_) k.resize(length_);
  }

  AdaptiveResult run(double begin, double end) {
    AdaptiveResult result;
    result.time = begin;
    if (begin == end || points_ == 0) {
      result.reached = true;
      result.time = end;
      return result;
    }
    const double direction = end > begin ? 1 : -1;
    const double smallest = 16 * std::numeric_limits<double>::epsilon() * std::max(std::abs(begin), std::abs(end));
    rate_(begin, y_, first_rate_.data());
    if (!all_finite(first_rate_)) {
      result.trouble = "the rate is not finite where it begins";
      return result;
    }
    double h = std::abs(end - begin) / 16;  // a first guess; the estimates correct it
    while (result.time != end) {
      if (result.steps + result.rejected >= options_.most_steps) {
        result.exhausted = true;
        result.trouble = "too many steps";
        return result;
      }
      h = std::min(h, step_limit());
      const double left = std::abs(end - result.time);
      const bool last = h >= left * (1 - 1e-12);
      // Two equal steps rather than a long one and a scrap.
      const double step = direction * (last ? left : h > left / 2 ? left / 2 : h);
      const double error = try_step(result.time, step);
      const double to = last ? end : result.time + step;
      if (error <= 1) {
        rate_(to, next_.data(), next_rate_.data());
        if (all_finite(next_rate_)) {
          if (options_.after_step)
            options_.after_step({result.time, to, y_, next_.data(), first_rate_.data(), next_rate_.data()});
          std::copy(next_.begin(), next_.end(), y_);
          first_rate_.swap(next_rate_);
          result.time = to;
          ++result.steps;
          h = std::abs(step) * std::clamp(0.9 * std::pow(error, -1. / 8), 0.3, 5.);
          continue;
        }
      }
      ++result.rejected;
      h = std::abs(step) * (std::isfinite(error) && error > 1 ? std::max(0.2, 0.9 * std::pow(error, -1. / 8)) : 0.2);
      if (h < smallest) {
        result.trouble = "the step that keeps the tolerance falls below rounding";
        return result;
      }
    }
    result.reached = true;
    return result;
  }

 private:
  // The longest step that the options allow at the present rates.
  double step_limit() const {
    double limit = options_.longest_step > 0 ? options_.longest_step : std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < options_.components.size(); ++c) {
      if (options_.components[c].largest_move <= 0) continue;
      const StepBound& bound = options_.components[c];
      for (std::size_t i = c * points_; i < (c + 1) * points_; ++i) {
        const double move = std::max(bound.largest_move, bound.share_of_distance * std::abs(y_[i] - bound.middle));
        if (const double speed = std::abs(first_rate_[i]); speed > 0) limit = std::min(limit, move / speed);
      }
    }
    return limit;
  }

  // y after the step in next_; the estimated error of the worst point, 1 being what is allowed.
  double try_step(double t, double h) {
    const Tableau& rk = dormand_prince_8();
    std::copy(first_rate_.begin(), first_rate_.end(), k_[0].begin());
    for (int s = 1; s < stages; ++s) {
      combine(rk, s, h);
      rate_(t + rk.c(s) * h, stage_.data(), k_[static_cast<std::size_t>(s)].data());
    }
    std::copy_n(y_, length_, next_.data());
    for (int s = 0; s < stages; ++s) {
      const double factor = h * rk.b(s);
      const double* k = k_[static_cast<std::size_t>(s)].data();
      if (factor != 0)
        for (std::size_t i = 0; i < length_; ++i) next_[i] += factor * k[i];
    }
    return estimate(rk, h);
  }

  void combine(const Tableau& rk, int s, double h) {
    std::copy_n(y_, length_, stage_.data());
    for (int l = 0; l < s; ++l) {
      const double factor = h * rk.a(s, l);
      if (factor == 0) continue;
      const double* k = k_[static_cast<std::size_t>(l)].data();
      for (std::size_t i = 0; i < length_; ++i) stage_[i] += factor * k[i];
    }
  }

  // |e_5|^2 / sqrt(|e_5|^2 + |e_3|^2 / 100) at each point, its components measured by what is allowed [HNW93, II.10].
  double estimate(const Tableau& rk, double h) {
    std::vector<double>&e5 = stage_, &e3 = next_rate_;  // free between the stages and the rate at the end
    std::fill(e5.begin(), e5.end(), 0.0);
    std::fill(e3.begin(), e3.end(), 0.0);
    for (std::size_t s = 0; s < stages; ++s) {
      const double factor_5 = h * error_5[s], factor_3 = h * (rk.weights[s] - weights_3[s]);
      if (factor_5 == 0 && factor_3 == 0) continue;
      const double* k = k_[s].data();
      for (std::size_t i = 0; i < length_; ++i) {
        e5[i] += factor_5 * k[i];
        e3[i] += factor_3 * k[i];
      }
    }
    double worst = 0;
    for (std::size_t i = 0; i < points_; ++i) {
      double square_5 = 0, square_3 = 0;
      for (std::size_t c = 0; c < options_.components.size(); ++c) {
        const std::size_t at = c * points_ + i;
        const StepBound& bound = options_.components[c];
        // Far outside, where steps are long, what counts is relative to the distance.
        const double distance = bound.share_of_distance * std::abs(y_[at] - bound.middle);
        const double absolute =
            distance > bound.largest_move ? bound.absolute * (distance / bound.largest_move) : bound.absolute;
        const double allowed = absolute + bound.relative * std::max(std::abs(y_[at]), std::abs(next_[at]));
        square_5 += (e5[at] / allowed) * (e5[at] / allowed);
        square_3 += (e3[at] / allowed) * (e3[at] / allowed);
      }
      const double whole = square_5 + 0.01 * square_3;
      const double error = whole > 0 ? square_5 / std::sqrt(whole) : 0;
      if (!std::isfinite(whole) || std::isnan(error)) return std::numeric_limits<double>::infinity();
      worst = std::max(worst, error);
    }
    return worst;
  }

  const BlockRate& rate_;
  std::size_t points_, length_;
  const AdaptiveOptions& options_;
  double* y_;
  std::vector<double> stage_, next_, first_rate_, next_rate_;
  std::array<std::vector<double>, stages> k_;
};

}  // namespace

AdaptiveResult integrate_adaptively(const BlockRate& rate, double begin, double end, std::size_t points,
                                    const AdaptiveOptions& options, double* state) {
  return Integration(rate, points, options, state).run(begin, end);
}

const Tableau& dormand_prince_8() {
  static const Tableau tableau{
      "dop853",
      stages,
      8,
      {
          // row by row
          5.26001519587677318785587544488e-2,
          1.97250569845378994544595329183e-2,
          5.91751709536136983633785987549e-2,
          2.95875854768068491816892993775e-2,
          0,
          8.87627564304205475450678981324e-2,
          2.41365134159266685502369798665e-1,
          0,
          -8.84549479328286085344864962717e-1,
          9.24834003261792003115737966543e-1,
          1. / 27,
          0,
          0,
          1.70828608729473871279604482173e-1,
          1.25467687566822425016691814123e-1,
          3.7109375e-2,
          0,
          0,
          1.70252211019544039314978060272e-1,
          6.02165389804559606850219397283e-2,
          -1.7578125e-2,
          3.70920001185047927108779319836e-2,
          0,
          0,
          1.70383925712239993810214054705e-1,
          1.07262030446373284651809199168e-1,
          -1.53194377486244017527936158236e-2,
          8.27378916381402288758473766002e-3,
          6.24110958716075717114429577812e-1,
          0,
          0,
          -3.36089262944694129406857109825,
          -8.68219346841726006818189891453e-1,
          2.75920996994467083049415600797e1,
          2.01540675504778934086186788979e1,
          -4.34898841810699588477366255144e1,
          4.77662536438264365890433908527e-1,
          0,
          0,
          -2.48811461997166764192642586468,
          -5.90290826836842996371446475743e-1,
          2.12300514481811942347288949897e1,
          1.52792336328824235832596922938e1,
          -3.32882109689848629194453265587e1,
          -2.03312017085086261358222928593e-2,
          -9.3714243008598732571704021658e-1,
          0,
          0,
          5.18637242884406370830023853209,
          1.09143734899672957818500254654,
          -8.14978701074692612513997267357,
          -1.85200656599969598641566180701e1,
          2.27394870993505042818970056734e1,
          2.49360555267965238987089396762,
          -3.0467644718982195003823669022,
          2.27331014751653820792359768449,
          0,
          0,
          -1.05344954667372501984066689879e1,
          -2.00087205822486249909675718444,
          -1.79589318631187989172765950534e1,
          2.79488845294199600508499808837e1,
          -2.85899827713502369474065508674,
          -8.87285693353062954433549289258,
          1.23605671757943030647266201528e1,
          6.43392746015763530355970484046e-1,
      },
      {5.42937341165687622380535766363e-2, 0, 0, 0, 0, 4.45031289275240888144113950566, 1.89151789931450038304281599044,
       -5.8012039600105847814672114227, 3.1116436695781989440891606237e-1, -1.52160949662516078556178806805e-1,
       2.01365400804030348374776537501e-1, 4.47106157277725905176885569043e-2},
      {0, 0.526001519587677318785587544488e-1, 0.789002279381515978178381316732e-1, 0.118350341907227396726757197510,
       0.281649658092772603273242802490, 1. / 3, 0.25, 4. / 13, 127. / 195, 0.6, 6. / 7, 1}};
  return tableau;
}

}  // namespace gaussdrift::time
