#include "effect/remesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "effect/catalogue.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

namespace {

// What one particle gives to the nodes first .. first + weights.size() - 1 of an axis.
struct AxisWeights {
  std::int64_t first = 0;
  std::vector<double> weights;
};

// Weights on the nodes of the unbounded lattice, in tiles that exist only where particles are.
class TiledSum {
 public:
  TiledSum(int dimension, std::size_t memory_limit) : dimension_(dimension), memory_limit_(memory_limit) {
    for (int k = 0; k < dimension; ++k) tile_size_ *= side;
  }

  void add(const std::array<AxisWeights, max_dimension>& axes, double weight) {
    const std::size_t nz = dimension_ > 2 ? axes[2].weights.size() : 1, ny = axes[1].weights.size();
    NodeIndex at{};
    for (std::size_t iz = 0; iz < nz; ++iz) {
      if (dimension_ > 2) at[2] = axes[2].first + static_cast<std::int64_t>(iz);
      const double wz = dimension_ > 2 ? weight * axes[2].weights[iz] : weight;
      for (std::size_t iy = 0; iy < ny; ++iy) {
        at[1] = axes[1].first + static_cast<std::int64_t>(iy);
        const double wy = wz * axes[1].weights[iy];
        const std::size_t nx = axes[0].weights.size();
        for (std::size_t ix = 0; ix < nx;) {  // stretches that lie in one tile
          at[0] = axes[0].first + static_cast<std::int64_t>(ix);
          double* line = node(at);
          const std::size_t stretch = std::min(nx - ix, static_cast<std::size_t>(side - floor_mod(at[0])));
          for (std::size_t i = 0; i < stretch; ++i) line[i] += wy * axes[0].weights[ix + i];
          ix += stretch;
        }
      }
    }
  }

  // Calls visit(index, value) for all nodes of all tiles, tiles in ascending order of their place.
  template <class Visit>
  void for_each(const Visit& visit) const {
    std::vector<const Tile*> ordered;
    for (const Tile& tile : tiles_) ordered.push_back(&tile);
    std::sort(ordered.begin(), ordered.end(), [](const Tile* a, const Tile* b) {
      return std::lexicographical_compare(a->place.rbegin(), a->place.rend(), b->place.rbegin(), b->place.rend());
    });
    for (const Tile* tile : ordered)
      for (std::size_t n = 0; n < tile_size_; ++n) {
        NodeIndex index{};
        std::size_t rest = n;
        for (int k = 0; k < dimension_; ++k) {
          index[k] = tile->place[k] * side + static_cast<std::int64_t>(rest % static_cast<std::size_t>(side));
          rest /= static_cast<std::size_t>(side);
        }
        visit(index, tile->values[n]);
      }
  }

 private:
  static constexpr std::int64_t side = 8;  // nodes of a tile an axis: a few kilobytes in 3D

  struct Tile {
    NodeIndex place{};
    std::vector<double> values;
  };

  static std::int64_t floor_mod(std::int64_t i) { return ((i % side) + side) % side; }

  double* node(const NodeIndex& at) {
    NodeIndex place{};
    std::size_t offset = 0;
    for (int k = dimension_ - 1; k >= 0; --k) {
      const std::int64_t inside = floor_mod(at[k]);
      place[k] = (at[k] - inside) / side;
      offset = offset * static_cast<std::size_t>(side) + static_cast<std::size_t>(inside);
    }
    if (tiles_.empty() || place != tiles_[last_].place) last_ = find_or_make(place);
    return tiles_[last_].values.data() + offset;
  }

  std::size_t find_or_make(const NodeIndex& place) {
    std::uint64_t key = 0;
    for (int k = 0; k < dimension_; ++k)
      key = key * 0x200003u + static_cast<std::uint64_t>(place[k] + (std::int64_t{1} << 30));
    auto& same_key = by_key_[key];  // the key is a hash: places are compared
    for (const std::size_t index : same_key)
      if (tiles_[index].place == place) return index;
    if ((tiles_.size() + 1) * (tile_size_ * sizeof(double) + 128) > memory_limit_)
      throw NumericalError(fmt::format(
          "remesh would need more than {} GiB for the nodes around the particles, because the particles lie too "
          "scattered. Remesh more often ([effects.remesh] every), lower particles.per_axis, or shorten time.end.",
          memory_limit_ >> 30));
    same_key.push_back(tiles_.size());
    tiles_.push_back({place, std::vector<double>(tile_size_, 0.0)});
    return tiles_.size() - 1;
  }

  int dimension_;
  std::size_t memory_limit_, tile_size_ = 1, last_ = 0;
  std::vector<Tile> tiles_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> by_key_;
};

}  // namespace

Remesh::Remesh(const Lattice& lattice, const Options& options)
    : nodes_(lattice), options_(options), kernel_(find_remesh_kernel(options.kernel)) {}

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

void Remesh::find_neighbours(const Particles& particles) {
  std::unordered_map<std::int64_t, std::size_t> at;
  at.reserve(particles.size());
  for (std::size_t j = 0; j < particles.size(); ++j) at.emplace(particles.id[j], j);
  neighbours_.clear();
  for (std::size_t j = 0; j < particles.size(); ++j)
    for (int k = 0; k < particles.dimension; ++k) {
      NodeIndex next = nodes_.index(particles.id[j]);
      ++next[k];
      if (next[k] >= nodes_.reach()) continue;
      if (const auto found = at.find(nodes_.id(next)); found != at.end()) neighbours_.emplace_back(j, found->second);
    }
  known_ = particles.size();
}

double Remesh::largest_stretch(const Particles& particles) {
  if (known_ != particles.size()) find_neighbours(particles);
  double heaviest = 0;
  for (const double alpha : particles.alpha) heaviest = std::max(heaviest, std::abs(alpha));
  // Particles of nearly no weight, as in a halo, may be far from each other without harm.
  const double light = 1e-6 * heaviest;
  double longest = 0;
  for (const auto& [a, b] : neighbours_) {
    if (std::abs(particles.alpha[a]) < light && std::abs(particles.alpha[b]) < light) continue;
    double square = 0;
    for (int k = 0; k < particles.dimension; ++k) {
      const double distance = particles.position[k][a] - particles.position[k][b];
      square += distance * distance;
    }
    longest = std::max(longest, square);
  }
  return std::sqrt(longest) / nodes_.lattice().spacing;
}

void Remesh::remesh(Particles& particles) {
  const int dimension = particles.dimension;
  const double h = nodes_.lattice().spacing;
  const double spread = particles.spread / (h * h);
  const bool into_weights = spread > 0 && spread >= kernel_.takes_spread;

  TiledSum sum(dimension, options_.memory_limit);
  std::array<AxisWeights, max_dimension> axes;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    if (particles.alpha[j] == 0) continue;
    for (int k = 0; k < dimension; ++k) {
      const double place = (particles.position[k][j] - nodes_.lattice().origin[k]) / h;
      if (!(std::abs(place) < static_cast<double>(nodes_.reach() / 2)))
        throw NumericalError(
            fmt::format("particle {} is {:.3g} lattice spacings away from the corner of the domain, which is too far "
                        "for remesh. Shorten time.end, or enlarge the domain.",
                        particles.id[j], std::abs(place)));
      kernel_.share(place, into_weights ? spread : 0, axes[k].first, axes[k].weights);
    }
    sum.add(axes, particles.alpha[j]);
  }

  double before = 0, heaviest = 0;
  for (const double alpha : particles.alpha) before += alpha;
  sum.for_each([&](const NodeIndex&, double value) { heaviest = std::max(heaviest, std::abs(value)); });
  if (heaviest == 0) return;  // nothing to carry
  Particles fresh;
  fresh.dimension = dimension;
  double total = 0, dropped = 0, negative = 0, mass = 0;
  sum.for_each([&](const NodeIndex& index, double value) {
    total += std::abs(value);
    if (value == 0 || std::abs(value) < options_.tolerance * heaviest) {
      dropped += std::abs(value);
      return;
    }
    const Vector x = nodes_.position(index);
    for (int k = 0; k < dimension; ++k) fresh.position[k].push_back(x[k]);
    fresh.alpha.push_back(value);
    fresh.id.push_back(nodes_.id(index));
    mass += value;
    negative += std::max(0.0, -value);
  });
  // The weight of nodes that are left out, and the rounding, go to the other nodes in proportion to their size.
  for (double& alpha : fresh.alpha) alpha += (before - mass) * std::abs(alpha) / (total - dropped);
  if (!particles.volume.empty()) fresh.volume.assign(fresh.size(), nodes_.cell());
  fresh.path.resize(particles.path.size());
  for (auto& integral : fresh.path) integral.assign(fresh.size(), 0.0);
  fresh.spread = into_weights ? 0 : particles.spread;
  particles = std::move(fresh);
  known_ = 0;
  ++remeshings_;
  most_negative_ = std::max(most_negative_, negative / total);
  most_dropped_ = std::max(most_dropped_, dropped / total);
}

void Remesh::pass_state(base::StateBytes& bytes, const Particles& /*particles*/) {
  bytes(steps_, remeshings_, most_negative_, most_dropped_);
  if (bytes.reading()) known_ = 0;  // neighbours follow from the particles
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
  Remesh::Options options{.kernel = effect.text("kernel"), .tolerance = effect.number("tolerance")};
  if (effect.has("every"))
    options.every = static_cast<int>(effect.number("every"));
  else
    options.stretch = effect.number("stretch");
  return std::make_unique<Remesh>(scene.seeding, options);
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
                     .keeps_density = true,
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
