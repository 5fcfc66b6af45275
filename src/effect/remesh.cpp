#include "effect/remesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <unordered_map>

#include "base/exact_sum.hpp"
#include "effect/catalogue.hpp"
#include "effect/meeting_rank.hpp"
#include "gaussdrift/error.hpp"
#include "particle/placing.hpp"

namespace gaussdrift {

Remesh::Remesh(const Lattice& lattice, const Options& options) : Remesh(lattice, options, alone_, {}) {}

Remesh::Remesh(const Lattice& lattice, const Options& options, base::Communicator& ranks, RankAt rank_at)
    : ranks_(ranks),
      rank_at_(std::move(rank_at)),
      nodes_(lattice, options.ends.any()),
      options_(options),
      kernel_(find_remesh_kernel(options.kernel)) {}

std::string Remesh::describe() const {
  const std::string when = options_.every > 0 ? fmt::format("every {} steps", options_.every)
                                              : fmt::format("where neighbours are {:g} h apart", options_.stretch);
  return fmt::format("remesh {} by {}", when, options_.kernel);
}

std::string Remesh::conserves() const {
  return fmt::format("mass; moments up to order {} but for weights below {:g} of the largest", kernel_.moments,
                     options_.tolerance);
}

bool Remesh::rearrange(Particles& particles, double /*time*/) {
  ++steps_;
  const bool due = options_.every > 0 ? steps_ % options_.every == 0 : largest_stretch(particles) > options_.stretch;
  if (due) remesh(particles);
  return due;
}

// Calls alone(j) for a particle that has not all of its neighbours here.
template <class Alone>
Remesh::Pairs Remesh::neighbours(const Particles& particles, const Alone& alone) const {
  std::unordered_map<std::int64_t, std::size_t> at;
  at.reserve(particles.size());
  for (std::size_t j = 0; j < particles.size(); ++j) at.emplace(particles.id[j], j);
  Pairs pairs;
  std::vector<int> met(particles.size(), 0);
  for (std::size_t j = 0; j < particles.size(); ++j)
    for (int k = 0; k < particles.dimension; ++k) {
      NodeIndex next = nodes_.index(particles.id[j]);
      next[k] = options_.ends.next(k, next[k]);
      if (next[k] >= nodes_.reach()) continue;
      if (const auto found = at.find(nodes_.id(next)); found != at.end()) {
        pairs.emplace_back(j, found->second);
        ++met[j], ++met[found->second];
      }
    }
  for (std::size_t j = 0; j < particles.size(); ++j)
    if (met[j] < 2 * particles.dimension) alone(j);
  return pairs;
}

void Remesh::find_neighbours(const Particles& particles) {
  at_border_.clear();
  neighbours_ = neighbours(particles, [&](std::size_t j) {
    if (ranks_.size() > 1) at_border_.push_back(j);
  });
  known_ = particles.size();
}

double Remesh::largest_stretch(const Particles& particles) {
  double heaviest = 0;
  ranks_.agree_on([&] {
    if (known_ != particles.size()) find_neighbours(particles);
    for (const double alpha : particles.alpha) heaviest = std::max(heaviest, std::abs(alpha));
  });
  ranks_.max(std::span(&heaviest, 1));
  // Particles of nearly no weight, as in a halo, may be far from each other without harm.
  const double light = 1e-6 * heaviest;
  const auto longest_of = [&](const Particles& some, const Pairs& pairs) {
    double longest = 0;
    for (const auto& [a, b] : pairs) {
      if (std::abs(some.alpha[a]) < light && std::abs(some.alpha[b]) < light) continue;
      double square = 0;
      for (int k = 0; k < some.dimension; ++k) {
        const double distance = options_.ends.distance(k, some.position[k][a], some.position[k][b]);
        square += distance * distance;
      }
      longest = std::max(longest, square);
    }
    return longest;
  };
  double longest = std::max(longest_of(particles, neighbours_), longest_to_image(particles, light));
  if (ranks_.size() > 1) {
    const Particles met = met_by_others(particles);
    ranks_.agree_on([&] { longest = std::max(longest, longest_of(met, neighbours(met, [](std::size_t) {}))); });
    ranks_.max(std::span(&longest, 1));
  }
  return std::sqrt(longest) / nodes_.lattice().spacing;
}

// The square of it.
double Remesh::longest_to_image(const Particles& particles, double light) const {
  double longest = 0;
  for (std::size_t j = 0; options_.ends.any() && j < particles.size(); ++j) {
    if (std::abs(particles.alpha[j]) < light) continue;
    const NodeIndex node = nodes_.index(particles.id[j]);
    for (int k = 0; k < particles.dimension; ++k) {
      const double distance = options_.ends.distance_to_image(k, node[k], particles.position[k][j]);
      longest = std::max(longest, distance * distance);
    }
  }
  return longest;
}

// Neighbours that are on different ranks meet on a third, which the node of the lower one tells.
Particles Remesh::met_by_others(const Particles& particles) const {
  const auto ranks = static_cast<std::size_t>(ranks_.size());
  std::vector<base::Bytes> out(ranks);
  ranks_.agree_on([&] {
    std::vector<std::vector<std::size_t>> chosen(ranks);
    const auto send = [&](std::size_t j, const NodeIndex& node) {
      auto& list = chosen[meeting_rank(node, nodes_.dimension(), ranks)];
      if (list.empty() || list.back() != j) list.push_back(j);
    };
    for (const std::size_t j : at_border_) {
      const NodeIndex node = nodes_.index(particles.id[j]);
      send(j, node);
      for (int k = 0; k < nodes_.dimension(); ++k) {
        NodeIndex lower = node;
        lower[k] = options_.ends.next(k, lower[k], -1);
        send(j, lower);
      }
    }
    for (std::size_t r = 0; r < ranks; ++r) out[r] = pack_bare(particles, chosen[r]);
  });
  return exchanged(particles.dimension, std::move(out));
}

Particles Remesh::exchanged(int dimension, std::vector<base::Bytes> out) const {
  Particles bare;
  bare.dimension = dimension;
  for (const base::Bytes& bytes : ranks_.exchange(std::move(out))) unpack(bytes, bare);
  sort_by_id(bare);
  return bare;
}

// What the particle gives to the nodes around it.
void Remesh::share(const Particles& particles, std::size_t j, double spread, NodeWeights& axes) const {
  const double h = nodes_.lattice().spacing;
  for (int k = 0; k < particles.dimension; ++k) {
    const double place = (particles.position[k][j] - nodes_.lattice().origin[k]) / h;
    if (!(std::abs(place) < static_cast<double>(nodes_.reach() / 2)))
      throw NumericalError(
          fmt::format("particle {} is {:.3g} lattice spacings away from the corner of the domain, which is too far "
                      "for remesh. Shorten time.end, or enlarge the domain.",
                      particles.id[j], std::abs(place)));
    kernel_.share(place, spread, axes[k].first, axes[k].weights);
  }
}

int Remesh::owner(const NodeIndex& first_of_block) const { return rank_at_(nodes_.position(first_of_block)); }

// The particles of all ranks that give something to nodes of this one.
Particles Remesh::felt_here(const Particles& particles, double spread) const {
  std::vector<base::Bytes> out(static_cast<std::size_t>(ranks_.size()));
  ranks_.agree_on([&] {
    std::vector<std::vector<std::size_t>> chosen(out.size());
    NodeWeights axes;
    for (std::size_t j = 0; j < particles.size(); ++j) {
      if (particles.alpha[j] == 0) continue;
      share(particles, j, spread, axes);
      options_.ends.for_each_part(axes, particles.dimension, [&](const NodeWeights& part) {
        NodeSums::for_each_block(part, particles.dimension, [&](const NodeIndex& first) {
          auto& list = chosen[static_cast<std::size_t>(owner(first))];
          if (list.empty() || list.back() != j) list.push_back(j);
        });
      });
    }
    for (std::size_t r = 0; r < out.size(); ++r) out[r] = pack_bare(particles, chosen[r]);
  });
  return exchanged(particles.dimension, std::move(out));
}

// A node's sum is taken on one rank, in the order of ids. Sums over nodes are exact. So bits do not depend on the ranks.
void Remesh::remesh(Particles& particles) {
  const int dimension = particles.dimension;
  const double spread = particles.spread / (nodes_.lattice().spacing * nodes_.lattice().spacing);
  const bool into_weights = spread > 0 && spread >= kernel_.takes_spread, several = ranks_.size() > 1;
  NodeSums::IsOwn is_own;
  if (several) is_own = [&](const NodeIndex& first) { return owner(first) == ranks_.rank(); };
  NodeSums sums(dimension, options_.memory_limit, is_own);
  const Particles felt = several ? felt_here(particles, into_weights ? spread : 0) : Particles();
  const Particles& sources = several ? felt : particles;
  double heaviest = 0;
  ranks_.agree_on([&] {
    NodeWeights axes;
    for (std::size_t j = 0; j < sources.size(); ++j) {
      if (sources.alpha[j] == 0) continue;
      share(sources, j, into_weights ? spread : 0, axes);
      options_.ends.for_each_part(axes, dimension, [&](const NodeWeights& part) { sums.add(part, sources.alpha[j]); });
    }
    heaviest = sums.largest();
  });
  ranks_.max(std::span(&heaviest, 1));
  if (heaviest == 0) return;  // nothing to carry

  Particles fresh;
  fresh.dimension = dimension;
  enum Total : std::size_t { before, all, dropped, kept, negative, totals };
  std::array<base::ExactSum, totals> exact;
  ranks_.agree_on([&] {
    exact[before].add(particles.alpha);
    sums.for_each([&](const NodeIndex& index, double value) {
      if (value == 0) return;
      exact[all].add(std::abs(value));
      if (std::abs(value) < options_.tolerance * heaviest) return exact[dropped].add(std::abs(value));
      const Vector x = nodes_.position(index);
      for (int k = 0; k < dimension; ++k) fresh.position[k].push_back(x[k]);
      fresh.alpha.push_back(value);
      fresh.id.push_back(nodes_.id(index));
      exact[kept].add(value);
      if (value < 0) exact[negative].add(-value);
    });
  });
  sum_over_ranks(ranks_, exact);
  const auto total = [&](Total which) { return exact[which].value(); };
  // The weight of nodes that are left out, and the rounding, go to the other nodes in proportion to their size.
  const double missing = (total(before) - total(kept)) / (total(all) - total(dropped));
  for (double& alpha : fresh.alpha) alpha += missing * std::abs(alpha);
  if (!particles.volume.empty()) fresh.volume.assign(fresh.size(), nodes_.cell());
  fresh.path.resize(particles.path.size());
  for (auto& integral : fresh.path) integral.assign(fresh.size(), 0.0);
  fresh.spread = into_weights ? 0 : particles.spread;
  sort_by_id(fresh);  // those beyond the lattice come first
  particles = std::move(fresh);
  known_ = unknown;
  ++remeshings_;
  most_negative_ = std::max(most_negative_, total(negative) / total(all));
  most_dropped_ = std::max(most_dropped_, total(dropped) / total(all));
}

void Remesh::pass_state(base::StateBytes& bytes, const Particles& /*particles*/) {
  bytes(steps_, remeshings_, most_negative_, most_dropped_);
  if (bytes.reading()) known_ = unknown;  // neighbours follow from the particles
}

Numbers Remesh::numbers() const {
  return {{"remeshings", static_cast<double>(remeshings_)},
          {"negative_weight", most_negative_},
          {"dropped_weight", most_dropped_}};
}

namespace {

std::vector<NamedChoice> kernel_choices() {
  std::vector<NamedChoice> choices;
  for (const RemeshKernel& kernel : remesh_kernels()) choices.push_back({kernel.name, kernel.meaning});
  return choices;
}

std::unique_ptr<Effect> make_remesh(const EffectSpec& effect, const EffectScene& scene) {
  Remesh::Options options{.kernel = effect.text("kernel"),
                          .tolerance = effect.number("tolerance"),
                          .ends = LatticeEnds(scene.spec.domain, scene.seeding)};
  if (effect.has("every"))
    options.every = static_cast<int>(effect.number("every"));
  else
    options.stretch = effect.number("stretch");
  return std::make_unique<Remesh>(scene.seeding, options, scene.ranks, scene.rank_at);
}

}  // namespace

namespace named {

NamedEffect remesh() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {.about =
              NamedFormula{
                  .name = "remesh",
                  .meaning = "the weights move to particles on a fresh lattice: whenever old neighbours have drifted "
                             "apart, or every so many steps",
                  .parameters = {{.name = "every",
                                  .kind = NamedParameter::Kind::whole,
                                  .range = {1, 1e9},
                                  .meaning = "number of steps from one remeshing to the next. Without it, `stretch` "
                                             "decides",
                                  .optional = true},
                                 {.name = "stretch",
                                  .fallback = "1.5",
                                  .range = {1, infinity, true},
                                  .meaning = "remesh as soon as particles that were neighbours are farther apart than "
                                             "this many spacings h. The overlap has then fallen to `particles.overlap` "
                                             "divided by this number. A case gives either this or `every`",
                                  .replaced_by = "every"},
                                 {.name = "kernel",
                                  .kind = NamedParameter::Kind::choice,
                                  .fallback = remesh_kernels().front().name,
                                  .meaning = "how weights are shared among the new nodes",
                                  .choices = kernel_choices},
                                 {.name = "tolerance",
                                  .fallback = "1e-09",
                                  .range = {0, 0.01},
                                  .meaning = "nodes with less than this part of the largest weight are left out. Their "
                                             "weight goes to the others"}}},
          .traits = {.replaces_particles = {.words = "remeshing makes new particles"},
                     .moves_weight = {.words = "remeshing moves weight between particles"},
                     .needs_lengths = {.words = "its lattice and its kernels are flat"},
                     .keeps_density = true,
                     .knows_edges = true,
                     .restores_overlap = true},
          // The table of neighbours; the nodes.
          .memory =
              [](const EffectSpec&, int dimension) {
                return EffectMemory{.kept = 16.0 * dimension, .step = dimension == 3 ? 150.0 : 100.0};
              },
          .make = make_remesh};
}

}  // namespace named

}  // namespace gaussdrift
