// What an output of a run shows: the density, by tiles where it is large, and its numbers.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>

#include "base/broadcast.hpp"
#include "base/has_one.hpp"
#include "base/nan.hpp"
#include "base/parallel.hpp"
#include "base/sphere.hpp"
#include "reference/norms.hpp"
#include "reference/sample.hpp"
#include "sim/borders/edges.hpp"
#include "sim/borders/outside.hpp"
#include "sim/density_pieces.hpp"
#include "sim/fields_on_grid.hpp"
#include "sim/follow/particle_fields.hpp"
#include "sim/grid_fields.hpp"
#include "sim/moments.hpp"
#include "sim/particle_pieces.hpp"
#include "sim/piece_comparison.hpp"
#include "sim/run_parts.hpp"
#include "sim/shared_reference.hpp"
#include "sim/sharing.hpp"
#include "sim/stepper.hpp"
#include "sim/tiled_density.hpp"

namespace gaussdrift {

namespace {

constexpr std::uint64_t most_reasons = 1000;  // for which particles leave: more is no state of a run

/// What a particle adds to the sums of a frame. After the centroid, which has a number an axis, comes what only some
/// cases count.
enum Addend : std::size_t { mass, weight, outside, centroid };

/// stops: whether particle j lies on land, for good; empty: none does.
FrameNumbers measure_particles(const Particles& particles, const Domain& domain, const Placement& place, int threads,
                               const std::function<bool(std::size_t j)>& stops) {
  // On a sphere the centre is that in space, brought to the surface.
  const auto dimension = static_cast<std::size_t>(domain.on_sphere() ? 3 : particles.dimension);
  const std::size_t inside = centroid + dimension, stopped = inside + (domain.counts_inside() ? 1 : 0),
                    count = stopped + (stops ? 2 : 0);
  const auto addends_of = [&](std::size_t j, double* of_particle) {
    const double alpha = particles.alpha[j];
    const bool is_out = is_outside(particles, j, domain);
    of_particle[mass] = alpha;
    of_particle[weight] = std::abs(alpha);
    of_particle[outside] = is_out ? std::abs(alpha) : 0;
    const Vector x = domain.on_sphere() ? on_unit_sphere(particles.position[0][j], particles.position[1][j])
                                        : particles.view().at(j);
    for (std::size_t k = 0; k < dimension; ++k) of_particle[centroid + k] = alpha * x[k];
    if (domain.counts_inside()) of_particle[inside] = is_out ? 0 : alpha;
    if (!stops) return;
    const bool lies = stops(j);
    of_particle[stopped] = lies ? 1 : 0;
    of_particle[stopped + 1] = lies ? alpha : 0;
  };
  const std::vector<double> sums = place.sums(particles, count, threads, addends_of);
  FrameNumbers numbers;
  numbers.mass = sums[mass];
  numbers.weight = sums[weight];
  numbers.outside = sums[weight] > 0 ? sums[outside] / sums[weight] : 0;
  if (domain.counts_inside()) numbers.inside = sums[inside];
  if (stops) numbers.stopped = {static_cast<std::uint64_t>(sums[stopped]), sums[stopped + 1]};
  // Where positive and negative weights cancel there is no centre of mass.
  const bool cancelled = std::abs(numbers.mass) <= 1e-12 * numbers.weight;
  for (std::size_t k = 0; k < dimension; ++k)
    numbers.centroid[k] = cancelled ? std::numeric_limits<double>::quiet_NaN() : sums[centroid + k] / numbers.mass;
  if (!domain.on_sphere()) return numbers;
  const Vector centre = longitude_and_latitude(numbers.centroid);
  numbers.centroid = {folding_of(domain).fold(0, centre[0]).x, centre[1], 0};
  return numbers;
}

// Particles and velocities of all ranks, by id.
std::pair<Particles, std::vector<double>> gathered(const Particles& particles, const std::vector<double>& velocity,
                                                   base::Communicator& ranks) {
  const auto dimension = static_cast<std::size_t>(particles.dimension);
  Particles carrying = particles;  // velocities travel as further integrals
  const std::size_t integrals = carrying.path.size();
  for (std::size_t k = 0; k < dimension; ++k) {
    std::vector<double>& column = carrying.path.emplace_back(particles.size());
    for (std::size_t j = 0; j < column.size() && !velocity.empty(); ++j) column[j] = velocity[j * dimension + k];
  }
  Particles all = gather_particles(carrying, ranks);
  std::vector<double> of_all(all.size() * dimension);
  for (std::size_t j = 0; j < all.size(); ++j)
    for (std::size_t k = 0; k < dimension; ++k) of_all[j * dimension + k] = all.path[integrals + k][j];
  all.path.resize(integrals);
  return {std::move(all), std::move(of_all)};
}

}  // namespace

// Numbers of an output, one by one: a new one must not be forgotten here. Those about edges are there only where the
// case has some, and so those about land and sources, so that what other cases keep stays as it is.
void pass(base::StateBytes& bytes, FrameNumbers& n, Counted counted) {
  static_assert(sizeof(FrameNumbers) == 296 + sizeof(std::string), "a number is not passed yet");
  if (counted.tracers) pass_tracers(bytes, n.tracers);
  if (counted.fields) pass_fields(bytes, n.fields);
  if (counted.sources) bytes(n.released, n.decayed);
  if (counted.stopped) {
    Stopped stopped = n.stopped.value_or(Stopped{});
    bytes(stopped.particles, stopped.mass);
    n.stopped = stopped;
  }
  if (counted.edges) {
    std::uint64_t reasons = n.left.size();
    bytes(n.inside, reasons);
    if (reasons > most_reasons) throw std::out_of_range("particles leave for too many reasons");
    n.left.resize(reasons);
    for (Departed& departed : n.left) bytes(departed.reason, departed.particles, departed.mass);
  }
  bytes(n.mass, n.minimum, n.maximum, n.centroid, n.transform_error, n.transform_tolerance, n.evaluate_seconds,
        n.seconds, n.stretch, n.weight, n.outside, n.error, n.no_norms, n.compared, n.untraced);
}

DensityOptions Simulation::Parts::density_options() const {
  const EvaluateSpec& evaluate = case_.evaluate;
  DensityOptions options;
  options.tolerance = showing_moment_ ? tolerance_of_moments(case_) : evaluate.tolerance;
  options.method = evaluate.method;
  options.hermite = evaluate.hermite;
  options.threads = threads_;
  options.tiles = usual_tiles(case_.domain.dimension);
  if (evaluate.tile_particles > 0) options.tiles->particles = static_cast<std::int64_t>(evaluate.tile_particles);
  options.tiles->pieces = pieces_.halvings();
  if (!tracer_alone_ && (!showing_moment_ || moment_has_fields()))
    options.derivatives = derivatives_of(case_.output, case_.domain.dimension);
  return options;
}

Cutoff Simulation::Parts::blob() const { return blob_of(scene_, particles_, part_of_spread_); }

// Particles to the ranks that carry them from `from` to the next landing, and sum the density at `from`.
void Simulation::Parts::place(double from) {
  if (placed_at_ == from) return;  // nothing has moved since
  placed_at_ = from;
  Tiles tiles = tiles_of(particles_, blob(), scene_.evaluation, density_options(),
                         [&](std::vector<std::int64_t>& counts) { ranks_.sum(counts); });
  place_.renew(particles_, std::move(tiles), work_of_tiles(case_, *scene_.velocity, from));
  if (ranks_.size() > 1 || carrier_.departures().possible()) carrier_.placed(particles_);
}

double Simulation::Parts::mass() const {
  return measure_particles(particles_, case_.domain, place_, threads_, {}).mass;
}

// [j][dimension], or nothing if only looked at. Throws NumericalError where the field is not finite.
std::vector<double> Simulation::Parts::velocity_at_particles(double time, bool wanted) const {
  const auto dimension = static_cast<std::size_t>(particles_.dimension);
  const std::size_t count = particles_.size();
  std::vector<double> columns(count * dimension, 0.0), velocity;
  VectorsView u{particles_.dimension, count, {}};
  for (std::size_t k = 0; k < dimension; ++k) u.axis[k] = columns.data() + k * count;
  const auto add = [&](base::Communicator* ranks) {
    add_flow_and_drifts(*scene_.velocity, carrier_.drifts(), time, particles_, particles_.view(), u, threads_, ranks);
  };
  if (carrier_.drifts().empty())
    ranks_.agree_on([&] { add(nullptr); });
  else
    add(&ranks_);
  ranks_.agree_on([&] { check_velocity(*scene_.velocity, particles_, u, time, steps_before_); });
  if (!wanted) return velocity;
  if (case_.domain.on_sphere()) {  // in degrees until here
    std::fill(columns.begin(), columns.end(), 0.0);
    ranks_.agree_on([&] { scene_.velocity->in_lengths().add(time, particles_.view(), u); });
  }
  if (case_.time.backwards)  // people know it as the case has it
    for (double& component : columns) component = -component;
  velocity.resize(count * dimension);
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t k = 0; k < dimension; ++k) velocity[j * dimension + k] = u.axis[k][j];
  if (case_.domain.coast == AtCoast::stop && scene_.coast)
    for (std::size_t j = 0; j < count; ++j)  // what lies on land does not move
      if (scene_.coast->is_land(time, particles_.view().at(j))) std::fill_n(&velocity[j * dimension], dimension, 0.0);
  return velocity;
}

// The density at the start stands for all: a run that has begun is not stopped.
void Simulation::Parts::check_density_seconds() const {
  const EvaluateSpec& evaluate = case_.evaluate;
  if (!limits_seconds(evaluate)) return;
  const auto predicted = [&](const std::string& method) {
    DensityOptions options = density_options();
    options.method = method;
    Particles images;
    return predict_density(summed(images), scene_.cutoff, scene_.evaluation, options);
  };
  ranks_.agree_on([&] {
    check_seconds(evaluate, predicted(evaluate.method), base::resolve_threads(threads_),
                  [&] { return predicted("auto"); });
  });
}

// Paths are shared; a formula is quick on rank 0.
void Simulation::Parts::plan_reference() {
  on_first([&] { compared_ = plan_comparison(case_, scene_, particle_count(), threads_); });
  base::broadcast_values(ranks_, [&](base::StateBytes& bytes) {
    bytes(compared_.points, compared_.following.most_steps, compared_.following.by_half_steps, compared_.word,
          compared_.left_out);
  });
  shares_reference_ = ranks_.size() > 1 && case_.reference.kind == ReferenceSpec::Kind::characteristics;
  if (compared_.points == 0 || !(place_.is_first() || shares_reference_ || compares_pieces())) return;
  Following following = compared_.following;
  if (shares_reference_)
    following.rank = static_cast<std::size_t>(ranks_.rank()), following.ranks = static_cast<std::size_t>(ranks_.size());
  reference_ = make_reference(case_, scene_, threads_, following);
  if (shares_reference_) reference_ = shared_reference(std::move(reference_), scene_.evaluation, ranks_);
}

// Beside the particles the images of them that reach the grid; `images` keeps those.
const Particles& Simulation::Parts::summed(Particles& images) const {
  return summed_particles(domain_of_sum(case_, leg_.now), particles_, reach_of_blob(blob(), density_options()), images);
}

// The same on all ranks, which agree on how it went.
const Particles& Simulation::Parts::images_agreed(Particles& images) const {
  const Particles* all = nullptr;
  ranks_.agree_on([&] { all = &summed(images); });
  return *all;
}

// On rank 0 the whole of it.
DensityGrid Simulation::Parts::sum_density(DensityReport& report) {
  if (!place_.one_tile()) return sum_tiles(report);
  DensityGrid density{scene_.evaluation, {}};
  on_first([&] {
    Particles images;
    density = evaluate_at_once(summed(images), blob(), scene_.evaluation, density_options(), &report);
  });
  return density;
}

DensityGrid Simulation::Parts::sum_tiles(DensityReport& report) {
  Particles images;
  const Particles& own = images_agreed(images);
  const Particles felt = felt_from_elsewhere(own, place_.tiles(), place_.owner(), ranks_);
  const std::vector<TileDensity> done = evaluate_tiles({own, felt}, place_.tiles(), place_.owned(), blob(),
                                                       scene_.evaluation, density_options(), ranks_, report);
  DensityGrid density{scene_.evaluation, {}};
  const auto& tiles = place_.tiles().list();
  const std::size_t quantities = density_options().quantities();
  if (place_.is_first()) {
    density.rho.resize(scene_.evaluation.size());
    report.derivatives.assign(quantities - 1, density.rho);
  }
  std::vector<double> values;  // of the others, tile after tile
  for (const auto& [tile, some] : done)
    if (place_.is_first())
      gaussdrift::place(some, tiles[tile], density, report.derivatives);
    else
      values.insert(values.end(), some.begin(), some.end());
  const std::vector<base::Bytes> arrived = ranks_.gather(base::to_bytes(values));
  if (!place_.is_first()) return density;
  std::vector<std::size_t> read(arrived.size(), 0);
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
    const auto from = static_cast<std::size_t>(place_.owner()[tile]);
    if (from == 0) continue;
    const std::size_t bytes = quantities * tiles[tile].size() * sizeof(double);
    const auto some = base::from_bytes<double>(std::span(arrived[from]).subspan(read[from], bytes));
    read[from] += bytes;
    gaussdrift::place(some, tiles[tile], density, report.derivatives);
  }
  return density;
}

// Of the density at the points of a piece, followed by its derivatives, leaves the density.
std::vector<FieldOnGrid> Simulation::Parts::fields_of_piece(double time, const LatticeBox& box,
                                                            std::vector<double>& values) const {
  std::vector<std::vector<double>> derivatives;
  for (std::size_t first = box.size(); first < values.size(); first += box.size()) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    derivatives.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(box.size()));
  }
  values.resize(box.size());
  return fields_on_grid(case_.output, scene_.evaluation, box, derivatives, scene_.velocity->shown(),
                        case_.time.at(time), threads_);
}

// Every k-th value on rank 0; the pieces go to the observers.
DensityGrid Simulation::Parts::sum_in_pieces(Frame& frame, DensityReport& report) {
  Particles images;
  const Particles& own = images_agreed(images);
  const Particles felt = felt_from_elsewhere(own, place_.tiles(), place_.owner(), ranks_);
  frame.pieces = &pieces_;
  frame.lattice = &scene_.evaluation;
  frame.every = thinning(scene_.evaluation);
  frame.pieces_have_exact = compares_pieces();
  for (const GridFieldKind* kind : fields_beside_density(case_.output))
    frame.piece_fields.emplace_back(kind->about.name, kind->components(case_.domain.dimension));
  PieceComparison comparison(scene_.evaluation, pieces_, largest_at_start_);
  const PieceReceiver receiver{
      .begin = [&] { comparison.begin(); },
      .piece =
          [&](std::size_t number, std::vector<double>& values) {
            std::vector<double> exact;
            const LatticeBox box = pieces_.shown(number);
            std::vector<FieldOnGrid> fields;
            if (!frame.piece_fields.empty())
              summary_.stages.run("fields on the grid", [&] { fields = fields_of_piece(frame.elapsed, box, values); });
            const std::vector<double>& rho = values;
            DensityPiece piece{number, box, &rho, nullptr, &fields};
            if (frame.pieces_have_exact) {
              summary_.stages.run("reference", [&] { comparison.compare(*reference_, frame.elapsed, piece, exact); });
              piece.exact = &exact;
            }
            for (const auto& observer : observers) {
              base::seam();
              summary_.stages.run(observer->name(), [&] { observer->piece(frame, piece); });
            }
          }};
  PiecesSummary all = sum_pieces({own, felt}, place_.tiles(), place_.owner(), blob(), scene_.evaluation, pieces_,
                                 density_options(), ranks_, receiver, report);
  frame.numbers.minimum = all.minimum;
  frame.numbers.maximum = all.maximum;
  if (frame.pieces_have_exact) comparison.tell(ranks_, frame.numbers);
  return std::move(all.thin);
}

// False if it was abandoned. A run that goes on from state() shows it again.
bool Simulation::Parts::show_or_abandon(double time) {
  if (abandon_wanted()) {
    base::StateBytes carrier;
    carrier_.pass_state(carrier, particles_);
    before_output_ = {summary_.frames.size(), summary_.reference, carrier.written()};
  }
  try {
    const base::AbandonableTogether while_it_lasts(ranks_, abandon_wanted());
    show_frame(time);
    return true;
  } catch (const base::Abandoned&) {
    forget_output();
    return false;
  }
}

void Simulation::Parts::forget_output() {
  summary_.frames.resize(before_output_.frames);
  index_ = static_cast<int>(before_output_.frames);
  summary_.reference = before_output_.reference;
  base::StateBytes carrier(before_output_.carrier);
  carrier_.pass_state(carrier, particles_);
}

void Simulation::Parts::show_frame(double time) {
  DensityReport report;
  place(time);
  Frame frame;
  frame.index = index_;
  frame.time = case_.time.at(time);
  frame.elapsed = time;
  std::function<bool(std::size_t)> stops;
  if (case_.domain.coast == AtCoast::stop)
    stops = [&](std::size_t j) { return scene_.coast && scene_.coast->is_land(time, particles_.view().at(j)); };
  frame.numbers = measure_particles(particles_, case_.domain, place_, threads_, stops);
  frame.numbers.left = carrier_.departures().so_far();
  if (releases_.possible()) frame.numbers.released = releases_.released(), frame.numbers.decayed = carrier_.decayed();
  frame.numbers.tracers = count_tracers();
  DensityGrid density = in_pieces() ? sum_in_pieces(frame, report) : sum_unless_tracers_do(report);
  summary_.stages.add("density", report.evaluate_seconds);
  summary_.stages.add("measure transform error", report.measure_seconds);
  summary_.transform_choice = report.choice;
  summary_.transform_achievable = std::max(summary_.transform_achievable, report.achievable);
  summary_.derivatives_achievable = std::max(summary_.derivatives_achievable, report.derivatives_achievable);
  summary_.derivatives_error = std::max(summary_.derivatives_error, report.derivatives_error);
  if (!in_pieces() && shows_fields(case_.output))
    on_first([&] {
      summary_.stages.run("fields on the grid", [&] {
        const LatticeBox all{{}, density.lattice.points};
        density.fields = fields_on_grid(case_.output, density.lattice, all, report.derivatives,
                                        scene_.velocity->shown(), case_.time.at(time), threads_);
        report.derivatives.clear();
      });
    });

  sum_tracers(time, density, frame.numbers.tracers, report);

  const bool velocity_wanted = base::has_one(case_.output.files, &OutputFile::needs_velocity);
  std::vector<double> velocity = velocity_at_particles(time, velocity_wanted);

  if (carrier_.keeps_neighbours())
    frame.numbers.stretch = largest_stretch(particles_, scene_.seeding, ranks_, folding_of(case_.domain));
  if (velocity_wanted)
    frame.particle_pieces = pieces_of_particles(place_.particle_count(), case_.output.piece_particles);
  frame.density = &density;
  if (frame.particle_pieces > 1) hand_out_pieces(frame, velocity);
  const bool elsewhere = ranks_.size() > 1 && !place_.one_tile() &&
                         (somebody_needs_particles(frame) || shows_where_particles_began() || counted().fields);
  std::pair<Particles, std::vector<double>> all;
  if (elsewhere) all = gathered(particles_, velocity, ranks_);
  frame.particles = elsewhere ? &all.first : &particles_;
  frame.velocity = !velocity_wanted ? nullptr : elsewhere ? &all.second : &velocity;
  std::vector<FieldOnGrid> of_particles;
  on_first([&] {
    of_particles = add_particle_fields(frame, density);
    frame.numbers.fields = count_fields(case_.checks, of_particles);
  });
  if (!of_particles.empty()) frame.particle_fields = &of_particles;
  std::vector<double> exact;
  const auto compare = [&] {
    if (reference_) summary_.stages.run("reference", [&] { compare_with_reference(density, frame, exact); });
  };
  if (shares_reference_)
    compare();
  else
    on_first(compare);
  on_first([&] {
    if (!in_pieces()) {
      const auto [low, high] = std::minmax_element(density.rho.begin(), density.rho.end());
      frame.numbers.minimum = *low;
      frame.numbers.maximum = *high;
    }
    frame.numbers.transform_error = report.measured_error;
    frame.numbers.transform_tolerance = report.requested_tolerance;
    frame.numbers.evaluate_seconds = report.evaluate_seconds;
    frame.numbers.seconds = seconds_before_ + watch_.seconds();
  });
  // All ranks know what is known of the outputs, and judge the run alike.
  base::broadcast_values(ranks_, [&](base::StateBytes& bytes) { pass(bytes, frame.numbers, counted()); });
  summary_.frames.emplace_back(time, frame.numbers);
  ++index_;  // not before: a disk that fills up with pieces leaves a state without this output
  on_first([&] {
    for (const auto& observer : observers) {
      base::seam();
      summary_.stages.run(observer->name(), [&] { observer->frame(frame); });
    }
  });
}

bool Simulation::Parts::somebody_needs_particles(const Frame& frame) const {
  std::int64_t needed = std::any_of(observers.begin(), observers.end(), [&](const auto& observer) {
    const bool has_pieces = frame.particle_pieces > 1 && observer->takes_particle_pieces();
    return !has_pieces && observer->needs_particles(frame.elapsed);
  });
  ranks_.max(std::span(&needed, 1));
  return needed != 0;
}

// On the whole grid, or on a sample of it. The density is on rank 0, and so is what comes out.
void Simulation::Parts::compare_with_reference(const DensityGrid& density, Frame& frame, std::vector<double>& exact) {
  ReferenceReport traced;
  if (in_pieces()) {
    traced = compare_thinned(density, frame, exact);
    if (!place_.is_first()) return;
  } else if (compares_everywhere()) {
    traced = reference_->evaluate(frame.elapsed, exact);
    if (!place_.is_first()) return;
    frame.exact = &exact;
    frame.numbers.error = compare(density.lattice, density.rho, exact);
    frame.numbers.compared = density.rho.size();
  } else {
    GridSample sample;
    if (place_.is_first()) sample = sample_of_grid(scene_.evaluation, density.rho, compared_.points);
    traced = reference_->evaluate_at(frame.elapsed, sample.points, exact);
    if (!place_.is_first()) return;
    frame.numbers.error = compare(density.rho, sample, exact);
    frame.numbers.compared = sample.points.size();
  }
  if (!compares_pieces()) frame.numbers.untraced = traced.untraced;
  judge_norms(exact, frame.numbers);
  if (summary_.reference.untraced == 0)
    summary_.reference = traced;
  else
    summary_.reference.untraced += traced.untraced;
}

// On the points that the thinned grid has, or on a sample of these.
ReferenceReport Simulation::Parts::compare_thinned(const DensityGrid& density, Frame& frame,
                                                   std::vector<double>& exact) {
  GridSample sample;
  const bool all = compared_.points >= density.lattice.size();
  std::vector<std::size_t> points;
  if (place_.is_first()) {
    sample = sample_of_grid(density.lattice, density.rho, compared_.points);
    points = points_of_thinned(sample.points, density.lattice, frame.every, scene_.evaluation);
  }
  const ReferenceReport traced = reference_->evaluate_at(frame.elapsed, points, exact);
  if (!place_.is_first()) return traced;
  if (all) frame.exact = &exact;
  if (compares_pieces()) return traced;
  frame.numbers.error = compare(density.rho, sample, exact);
  frame.numbers.compared = sample.points.size();
  return traced;
}

// Norms are relative to the exact density. They mean nothing where that is nearly 0.
void Simulation::Parts::judge_norms(const std::vector<double>& exact, FrameNumbers& numbers) const {
  double largest = -1;
  for (const double value : exact) largest = std::max(largest, std::abs(value));  // not of NaN
  if (largest < 0) {
    numbers.no_norms = "the exact density is not known anywhere";
  } else if (largest == 0 || (is_all(numbers.outside) && is_nothing(largest, largest_at_start_))) {
    numbers.no_norms = numbers.weight == 0 && has_left(numbers)
                           ? "nothing is left to compare (all of the mass has left the domain)"
                           : why_nothing_is_left(numbers.outside, numbers.weight);
    using base::nan;
    numbers.error = ErrorNorms{nan, nan, nan};
  }
}

}  // namespace gaussdrift
