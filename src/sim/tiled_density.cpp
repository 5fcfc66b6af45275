#include "sim/tiled_density.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "base/sphere.hpp"
#include "base/stopwatch.hpp"
#include "sim/blob_sum.hpp"
#include "sim/transform_errors.hpp"

namespace gaussdrift {

namespace {

constexpr std::size_t most_candidates = 16;  // of each kind: the heaviest, and one of each of the fullest tiles

// Particles by number: a process's own first, then those of others.
class BothParts {
 public:
  explicit BothParts(const TileSources& sources) : sources_(sources), own_(sources.own.size()) {}

  std::size_t own() const { return own_; }
  double weight(std::size_t j) const { return of(j).alpha[at(j)]; }
  std::int64_t id(std::size_t j) const { return of(j).id[at(j)]; }
  double coordinate(int axis, std::size_t j) const { return of(j).position[axis][at(j)]; }
  Vector place(std::size_t j) const { return of(j).view().at(at(j)); }
  Particles places_and_weights(const std::vector<std::size_t>& chosen) const {
    Particles some;
    some.dimension = sources_.own.dimension;
    for (int k = 0; k < some.dimension; ++k) {
      some.position[k].resize(chosen.size());
      for (std::size_t i = 0; i < chosen.size(); ++i) some.position[k][i] = coordinate(k, chosen[i]);
    }
    some.alpha.resize(chosen.size());
    for (std::size_t i = 0; i < chosen.size(); ++i) some.alpha[i] = weight(chosen[i]);
    return some;
  }

 private:
  const Particles& of(std::size_t j) const { return j < own_ ? sources_.own : sources_.felt; }
  std::size_t at(std::size_t j) const { return j < own_ ? j : j - own_; }

  TileSources sources_;
  std::size_t own_;
};

// For each tile that is wanted, the particles that reach it, by id: sums do not depend on who brought them.
std::vector<std::vector<std::size_t>> sources_of_tiles(const TileSources& sources, const Tiles& tiles,
                                                       const std::vector<char>& wanted, int threads) {
  auto chosen = tiles.gather(sources.own.view(), wanted, threads);
  if (sources.felt.size() == 0) return chosen;
  const BothParts both(sources);
  const auto felt = tiles.gather(sources.felt.view(), wanted, threads);
  for (std::size_t t = 0; t < chosen.size(); ++t) {
    const auto own = static_cast<std::ptrdiff_t>(chosen[t].size());
    for (const std::size_t j : felt[t]) chosen[t].push_back(both.own() + j);
    std::inplace_merge(chosen[t].begin(), chosen[t].begin() + own, chosen[t].end(),
                       [&](std::size_t a, std::size_t b) { return both.id(a) < both.id(b); });
  }
  return chosen;
}

// The heaviest of all processes.
std::vector<Candidate> heaviest(const TileSources& sources, base::Communicator& ranks) {
  std::vector<Candidate> best;
  for (std::size_t j = 0; j < sources.own.size(); ++j) {
    const Candidate candidate{std::abs(sources.own.alpha[j]), sources.own.id[j]};
    if (best.size() == most_candidates && !(candidate < best.back())) continue;
    best.insert(std::upper_bound(best.begin(), best.end(), candidate), candidate);
    if (best.size() > most_candidates) best.pop_back();
  }
  std::vector<Candidate> of_all;
  for (const base::Bytes& bytes : ranks.gather(base::to_bytes(best))) {
    const auto some = base::from_bytes<Candidate>(bytes);
    of_all.insert(of_all.end(), some.begin(), some.end());
  }
  std::sort(of_all.begin(), of_all.end());
  of_all.resize(std::min(of_all.size(), most_candidates));
  base::Bytes chosen = base::to_bytes(of_all);
  ranks.broadcast(chosen);
  return base::from_bytes<Candidate>(chosen);
}

std::vector<std::size_t> fullest(const Tiles& tiles) {
  std::vector<std::size_t> order(tiles.list().size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto count = static_cast<std::ptrdiff_t>(std::min(order.size(), most_candidates));
  std::partial_sort(order.begin(), order.begin() + count, order.end(), [&](std::size_t a, std::size_t b) {
    const auto in_a = tiles.list()[a].particles, in_b = tiles.list()[b].particles;
    return in_a != in_b ? in_a > in_b : a < b;
  });
  order.resize(static_cast<std::size_t>(count));
  return order;
}

template <int d, int e>
class SumsInDimension : public TileSums {
 public:
  SumsInDimension(const TileSources& sources, const Tiles& tiles, const std::vector<char>& owned, const Cutoff& cutoff,
                  const Lattice& lattice, const DensityOptions& options)
      : particles_(sources),
        tiles_(tiles),
        owned_(owned),
        cutoff_(cutoff),
        lattice_(lattice),
        options_(options),
        fullest_(fullest(tiles).front()),
        of_tile_(sources_of_tiles(sources, tiles, owned, options.threads)) {}

  OfQuantities lower_bounds_of_maxima(const std::vector<Candidate>& heaviest) const override {
    std::map<std::size_t, std::vector<Vector>> places;  // by tile
    std::vector<std::int64_t> ids;
    for (const Candidate& candidate : heaviest) ids.push_back(candidate.id);
    std::sort(ids.begin(), ids.end());
    for (std::size_t j = 0; j < particles_.own(); ++j)
      if (std::binary_search(ids.begin(), ids.end(), particles_.id(j))) {
        const Vector x = particles_.place(j);
        places[tiles_.of(x)].push_back(x);
      }
    for (const std::size_t tile : fullest(tiles_)) {
      if (!owned_[tile]) continue;
      const auto& chosen = of_tile_[tile];
      for (std::size_t i = chosen.size() / 2; i < chosen.size(); ++i) {
        const Vector x = particles_.place(chosen[i]);
        if (tiles_.of(x) != tile) continue;  // beyond the border, where not all that counts is known
        places[tile].push_back(x);
        break;
      }
    }
    OfQuantities largest(options_.quantities(), 0.0);
    for (const auto& [tile, of_tile] : places)
      if (owned_[tile]) raise(largest, largest_at(of_tile, of_tile_[tile]));
    return largest;
  }

  void begin(const OfQuantities& maxima, DensityReport& report) override {
    maxima_ = maxima;
    largest_.assign(options_.quantities(), 0.0);
    errors_ = largest_;
    sample_ = 0;
    report.requested_tolerance = 1, report.achievable = 0, report.measure_seconds = 0;
    report.derivatives_achievable = 0;
    choice_of_fullest_.clear();
    samples_ = sample_of_tiles();
  }

  std::vector<double> sum(std::size_t tile, const LatticeBox& where, bool main, DensityReport& report) override {
    const auto nothing = [&] { return std::vector<double>(where.size() * options_.quantities(), 0.0); };
    if (of_tile_[tile].empty() || where.size() == 0) return nothing();
    const Particles some = particles_.places_and_weights(main ? of_tile_[tile] : within_reach(tile, where));
    if (some.size() == 0) return nothing();
    BlobSum<d, e> blobs(some, cutoff_, options_);
    DensityReport of_tile;
    blobs.choose_tolerance(blobs.error_of_unit_tolerance(some), maxima_, of_tile);
    const Eigen::MatrixXd matrix = blobs.transform(nodes_of(lattice_, where), of_tile);
    const std::vector<double> values(matrix.data(), matrix.data() + matrix.size());
    report.requested_tolerance = std::min(report.requested_tolerance, of_tile.requested_tolerance);
    report.achievable = std::max(report.achievable, of_tile.achievable);
    report.derivatives_achievable = std::max(report.derivatives_achievable, of_tile.derivatives_achievable);
    if (main && tile == fullest_) choice_of_fullest_ = of_tile.choice;
    const Eigen::RowVectorXd largest = matrix.cwiseAbs().colwise().maxCoeff();
    raise(largest_, {largest.begin(), largest.end()});
    if (options_.measure) {
      const base::Stopwatch measuring;
      measure(blobs, where, values, samples_of(tile, where), main);
      report.measure_seconds += measuring.seconds();
    }
    return values;
  }

  // The work of all tiles, predicted and not done.
  DensityWork predict(const OfQuantities& maxima) const {
    std::map<std::string, double> seconds;  // of each method
    for (std::size_t tile = 0; tile < owned_.size(); ++tile) {
      if (!owned_[tile] || of_tile_[tile].empty()) continue;
      const Tile& where = tiles_.list()[tile];
      const Particles some = particles_.places_and_weights(of_tile_[tile]);
      BlobSum<d, e> blobs(some, cutoff_, options_);
      DensityReport ignored;
      blobs.choose_tolerance(blobs.error_of_unit_tolerance(some), maxima, ignored);
      const DensityWork work = blobs.predict(nodes_of(lattice_, where));
      seconds[work.method] += work.seconds;
    }
    DensityWork all;
    double most = -1;
    for (const auto& [method, of_method] : seconds) {
      all.seconds += of_method;
      if (of_method > most) most = of_method, all.method = method;
    }
    return all;
  }

  const OfQuantities& largest() const override { return largest_; }
  const OfQuantities& errors() const override { return errors_; }
  std::int64_t sample() const override { return sample_; }
  const std::string& choice_of_fullest() const override { return choice_of_fullest_; }

 private:
  // By pairs within reach, because only these count.
  OfQuantities largest_at(const std::vector<Vector>& places, const std::vector<std::size_t>& chosen) const {
    const double reach = reach_of_blob(cutoff_, options_);
    OfQuantities largest(options_.quantities(), 0.0);
    for (const Vector& x : places) {
      std::vector<std::size_t> near;
      for (const std::size_t j : chosen) {
        bool within = true;
        if (e != d)
          within = lattice_.sphere * angle_between(particles_.place(j), x) <= 2 * reach;
        else
          for (int k = 0; k < d; ++k) within = within && std::abs(particles_.coordinate(k, j) - x[k]) <= reach;
        if (within) near.push_back(j);
      }
      fgtd::Points<d> target(d, 1);
      for (int k = 0; k < d; ++k) target(k, 0) = x[static_cast<std::size_t>(k)];
      const BlobSum<d, e> blobs(particles_.places_and_weights(near), cutoff_, options_);
      raise(largest, blobs.largest_near(target));
    }
    return largest;
  }

  // Grid points to compare with pairs: a low-discrepancy choice over the whole grid, numbers within the tile for each.
  std::vector<std::vector<std::size_t>> sample_of_tiles() const {
    std::vector<std::vector<std::size_t>> samples(owned_.size());
    if (!options_.measure) return samples;
    std::int64_t count = 0, filled = 0;
    for (const Tile& tile : tiles_.list()) count += tile.particles, filled += tile.particles > 0;
    // At most 2e7 pairs, so that measuring stays a small part of any run; never fewer than 4 points.
    const std::int64_t wanted =
        std::clamp<std::int64_t>(20'000'000 * filled / std::max<std::int64_t>(1, count), 4, 200);
    for (std::size_t rest : spread_numbers(lattice_.size(), static_cast<std::size_t>(wanted))) {
      std::array<std::size_t, max_dimension> index{};
      Vector x{};
      for (int k = 0; k < d; ++k) {
        index[k] = rest % lattice_.points[k], rest /= lattice_.points[k];
        x[k] = lattice_.coordinate(k, index[k]) + 0.5 * lattice_.spacing;  // safely in the cell above the point
      }
      const std::size_t tile = tiles_.of(x);
      const Tile& where = tiles_.list()[tile];
      std::size_t number = 0;
      for (int k = d - 1; k >= 0; --k) number = number * where.points[k] + (index[k] - where.first[k]);
      samples[tile].push_back(number);
    }
    return samples;
  }

  // Those of the sample that lie there, as numbers within the box.
  std::vector<std::size_t> samples_of(std::size_t tile, const LatticeBox& where) const {
    const Tile& all = tiles_.list()[tile];
    std::vector<std::size_t> chosen;
    for (const std::size_t number : samples_[tile]) {
      const std::size_t i = all.first[0] + number % all.points[0];
      const std::size_t j = all.first[1] + number / all.points[0] % all.points[1];
      const std::size_t l = all.first[2] + number / all.points[0] / all.points[1];
      if (i >= where.first[0] && i < where.end(0) && j >= where.first[1] && j < where.end(1) && l >= where.first[2] &&
          l < where.end(2))
        chosen.push_back(where.number(i, j, l));
    }
    return chosen;
  }

  // Of the particles that reach the tile, those that reach this part of it.
  std::vector<std::size_t> within_reach(std::size_t tile, const LatticeBox& where) const {
    if (e != d) return of_tile_[tile];  // of a sphere: longitudes of a box say little
    const double reach = reach_of_blob(cutoff_, options_);
    std::vector<std::size_t> near;
    for (const std::size_t j : of_tile_[tile]) {
      bool within = true;
      for (int k = 0; k < d; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        const double x = particles_.coordinate(k, j), low = lattice_.coordinate(k, where.first[axis]),
                     high = lattice_.coordinate(k, where.end(axis) - 1);
        within = within && x >= low - reach && x <= high + reach;
      }
      if (within) near.push_back(j);
    }
    return near;
  }

  // At the sample, and in the main part of a tile where each quantity is largest in it.
  void measure(const BlobSum<d, e>& blobs, const LatticeBox& where, const std::vector<double>& values,
               std::vector<std::size_t> sample, bool main) {
    for (std::size_t q = 0; main && q < options_.quantities(); ++q)
      sample.push_back(number_of_largest({values.data() + q * where.size(), where.size()}));
    if (sample.empty()) return;
    raise(errors_, blobs.largest_errors(lattice_, where, values, sample));
    sample_ += static_cast<std::int64_t>(sample.size());
  }

  BothParts particles_;
  const Tiles& tiles_;
  const std::vector<char>& owned_;
  const Cutoff& cutoff_;
  const Lattice& lattice_;
  const DensityOptions& options_;
  std::size_t fullest_;
  std::vector<std::vector<std::size_t>> of_tile_;  // numbers of the particles that count, by id
  std::vector<std::vector<std::size_t>> samples_;  // numbers of grid points within the tile
  OfQuantities maxima_, errors_, largest_;
  std::int64_t sample_ = 0;
  std::string choice_of_fullest_;
};

double largest_of(base::Communicator& ranks, double number) {
  ranks.max(std::span(&number, 1));
  return number;
}

OfQuantities largest_of(base::Communicator& ranks, OfQuantities numbers) {
  ranks.max(std::span(numbers));
  return numbers;
}

std::string told_by_whom_it_concerns(base::Communicator& ranks, const std::string& own) {
  base::Bytes told;
  for (const base::Bytes& bytes : ranks.gather(base::to_bytes(own)))
    if (!bytes.empty()) told = bytes;
  ranks.broadcast(told);
  return base::to_text(told);
}

}  // namespace

// At that distance a second derivative is some hundred times larger, relative to its largest value, than the blob.
double reach_of_blob(const Cutoff& cutoff, const DensityOptions& options) {
  return reach(cutoff, options.derivatives.empty() ? 1e-14 : 1e-17);
}

void sum_by_tiles(const TileSources& sources, const Tiles& tiles, const std::vector<char>& owned, const Cutoff& cutoff,
                  const Lattice& lattice, const DensityOptions& options, base::Communicator& ranks,
                  const std::function<void(TileSums&)>& sum_all, DensityReport& report) {
  const base::Stopwatch evaluating;
  std::unique_ptr<TileSums> sums;
  OfQuantities expected;
  const std::vector<Candidate> candidates = heaviest(sources, ranks);
  ranks.agree_on([&] {
    in_dimensions(lattice.dimension, cutoff, [&](auto d, auto e) {
      sums = std::make_unique<SumsInDimension<d, e>>(sources, tiles, owned, cutoff, lattice, options);
    });
    expected = sums->lower_bounds_of_maxima(candidates);
  });
  expected = largest_of(ranks, expected);
  const auto sum_to = [&](const OfQuantities& maxima) {
    ranks.agree_on([&] { sums->begin(maxima, report); });
    sum_all(*sums);
    return largest_of(ranks, sums->largest());
  };
  OfQuantities found = sum_to(expected);
  // Where most of the density has left the grid, the largest value on it decides, and the first tolerance was too
  // coarse.
  if (found[0] > 0 && is_too_coarse(found, expected)) found = sum_to(OfQuantities(found));
  report.requested_tolerance = -largest_of(ranks, -report.requested_tolerance);
  report.achievable = largest_of(ranks, report.achievable);
  report.derivatives_achievable = largest_of(ranks, report.derivatives_achievable);
  tell_errors(largest_of(ranks, sums->errors()), found, report);
  std::int64_t sample = sums->sample();
  ranks.sum(std::span(&sample, 1));
  report.sample = static_cast<std::size_t>(sample);
  report.choice = fmt::format("{} tiles, the fullest by {}", tiles.list().size(),
                              told_by_whom_it_concerns(ranks, sums->choice_of_fullest()));
  report.evaluate_seconds = evaluating.seconds() - report.measure_seconds;
}

std::vector<TileDensity> evaluate_tiles(const TileSources& sources, const Tiles& tiles, const std::vector<char>& owned,
                                        const Cutoff& cutoff, const Lattice& lattice, const DensityOptions& options,
                                        base::Communicator& ranks, DensityReport& report) {
  std::vector<TileDensity> densities;
  sum_by_tiles(
      sources, tiles, owned, cutoff, lattice, options, ranks,
      [&](TileSums& sums) {
        ranks.agree_on([&] {
          in_words_of_a_case([&] {
            densities.clear();
            for (std::size_t tile = 0; tile < owned.size(); ++tile)
              if (owned[tile]) densities.push_back({tile, sums.sum(tile, tiles.list()[tile], true, report)});
          });
        });
      },
      report);
  return densities;
}

void place(std::span<const double> values, const Tile& tile, DensityGrid& whole,
           std::vector<std::vector<double>>& derivatives) {
  const Lattice& lattice = whole.lattice;
  for (std::size_t q = 0; q <= derivatives.size(); ++q) {
    const std::span<const double> some = values.subspan(q * tile.size(), tile.size());
    std::vector<double>& all = q == 0 ? whole.rho : derivatives[q - 1];
    for (std::size_t l = 0; l < tile.points[2]; ++l)
      for (std::size_t j = 0; j < tile.points[1]; ++j) {
        const std::size_t line = (tile.first[2] + l) * lattice.points[1] + tile.first[1] + j;
        std::copy_n(some.begin() + static_cast<std::ptrdiff_t>((l * tile.points[1] + j) * tile.points[0]),
                    tile.points[0],
                    all.begin() + static_cast<std::ptrdiff_t>(line * lattice.points[0] + tile.first[0]));
      }
  }
}

DensityWork predict_tiles(const Particles& particles, const Tiles& tiles, const Cutoff& cutoff, const Lattice& lattice,
                          const DensityOptions& options) {
  const std::vector<char> all(tiles.list().size(), 1);
  const Particles none;
  const TileSources sources{particles, none};
  base::Communicator alone;
  const auto predict = [&](auto sums) { return sums.predict(sums.lower_bounds_of_maxima(heaviest(sources, alone))); };
  return in_dimensions(lattice.dimension, cutoff, [&](auto d, auto e) {
    return predict(SumsInDimension<d, e>(sources, tiles, all, cutoff, lattice, options));
  });
}

}  // namespace gaussdrift
