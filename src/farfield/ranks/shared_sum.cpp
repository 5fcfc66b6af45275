#include "farfield/ranks/shared_sum.hpp"

#include <algorithm>
#include <string>

namespace farfield::detail {
namespace {

void make_room(const Problem& problem, std::size_t count, Sums& sums) {
  if (problem.potential) sums.potential.assign(count + padding, 0.0);
  for (std::size_t l = 0; l < static_cast<std::size_t>(problem.dimension()); ++l)
    sums.field[l].assign(count + padding, 0.0);
}

}  // namespace

template <int d>
void SharedSum<d>::evaluate(const Buffer<double>& charges, Sums& sums, Seconds& seconds) const {
  const Buffer<double> here = homes_->charges_here(channel_, charges);
  Sums found;
  if (potential_) found.potential.assign(homes_->arrived() + padding, 0.0);
  for (std::size_t l = 0; l < d; ++l) found.field[l].assign(homes_->arrived() + padding, 0.0);
  own_->evaluate(here, found, seconds);
  homes_->results_home(channel_, found, potential_, sums);
}

template <int d>
double SharedSum<d>::evaluation_bytes() const {
  return own_->evaluation_bytes() + 16.0 * static_cast<double>(homes_->arrived()) * (d + 2);
}

template <int d>
SharedDirect<d>::SharedDirect(const Channel& channel, const Problem& problem, std::span<const std::int64_t> numbers,
                              int threads, Received& received)
    : channel_(channel), threads_(threads) {
  all_.interaction = problem.interaction;
  all_.potential = problem.potential;
  all_.inverse_squared_core = problem.inverse_squared_core;
  all_.log_shift = problem.log_shift;
  all_.sources = all_.targets = problem.sources;
  Writer to;
  to.put(numbers.size());
  to.put(numbers.data(), numbers.size());
  for (std::size_t l = 0; l < d; ++l) to.put(problem.source[l].data(), numbers.size());
  const std::vector<Bytes> in = channel.exchange(std::vector<Bytes>(channel.size(), to.take()), received.points);

  struct Point {
    std::int64_t number;
    std::uint32_t rank;
    Index place;
  };
  std::vector<Point> points;
  points.reserve(all_.sources);
  std::vector<Reader> readers;
  place_.resize(channel.size());
  for (std::size_t r = 0; r < in.size(); ++r) {
    place_[r].resize(readers.emplace_back(in[r]).get<std::size_t>());
    for (std::size_t i = 0; i < place_[r].size(); ++i)
      points.push_back({readers[r].get<std::int64_t>(), static_cast<std::uint32_t>(r), static_cast<Index>(i)});
  }
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.number < b.number; });
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && points[i - 1].number == points[i].number)  // all ranks see it
      throw InvalidArgument("farfield: two points have the number " + std::to_string(points[i].number) +
                            "; the numbers of all points of all ranks must differ");
    place_[points[i].rank][points[i].place] = static_cast<Index>(i);
  }
  std::vector<double> column;
  for (std::size_t l = 0; l < d; ++l) {
    all_.source[l].assign(all_.sources + padding, 0.0);
    for (std::size_t r = 0; r < in.size(); ++r) {
      column.resize(place_[r].size());
      readers[r].get(column.data(), column.size());
      for (std::size_t i = 0; i < column.size(); ++i) all_.source[l][place_[r][i]] = column[i];
    }
  }
  // Of an evaluation: charges of others, and results of other ranks.
  const std::size_t own = numbers.size(), columns = d + all_.potential;
  const Range here = targets_of(channel.rank());
  std::size_t away = 0;
  for (const Index i : place_[channel.rank()]) away += i < here.begin || i >= here.end;
  received.points += sizeof(double) * static_cast<double>(all_.sources - own + away * columns);
}

template <int d>
Range SharedDirect<d>::targets_of(std::size_t rank) const {
  // Whole pieces: vectors of targets begin where they do on one rank.
  const std::size_t pieces = (all_.targets + Direct::piece - 1) / Direct::piece, ranks = channel_.size();
  return {std::min(all_.targets, pieces * rank / ranks * Direct::piece),
          std::min(all_.targets, pieces * (rank + 1) / ranks * Direct::piece)};
}

template <int d>
void SharedDirect<d>::evaluate(const Buffer<double>& charges, Sums& sums, Seconds& seconds) const {
  const std::vector<Index>& own = place_[channel_.rank()];
  Writer to;
  to.put(charges.data(), own.size());
  std::vector<Bytes> in = channel_.exchange(std::vector<Bytes>(channel_.size(), to.take()));
  Buffer<double> all;
  all.assign(all_.sources + padding, 0.0);
  for (std::size_t r = 0; r < in.size(); ++r) {
    Reader from(in[r]);
    for (const Index i : place_[r]) all[i] = from.get<double>();
  }
  Sums found;
  make_room(all_, all_.targets, found);
  const Range here = targets_of(channel_.rank());
  Direct(all_, threads_, here).evaluate(all, found, seconds);

  // Each rank gets what was summed for its points, in the order in which it has them.
  const auto for_each_column = [&](const auto& use) {
    if (all_.potential) use(found.potential, sums.potential);
    for (std::size_t l = 0; l < d; ++l) use(found.field[l], sums.field[l]);
  };
  const auto is_in = [](const Range& range, Index i) { return range.begin <= i && i < range.end; };
  std::vector<Bytes> out(channel_.size());
  for (std::size_t r = 0; r < out.size(); ++r) {
    Writer results;
    for_each_column([&](const Buffer<double>& column, const Buffer<double>&) {
      for (const Index i : place_[r])
        if (is_in(here, i)) results.put(column[i]);
    });
    out[r] = results.take();
  }
  in = channel_.exchange(std::move(out));
  for (std::size_t r = 0; r < in.size(); ++r) {
    const Range there = targets_of(r);
    Reader from(in[r]);
    for_each_column([&](const Buffer<double>&, Buffer<double>& home) {
      for (std::size_t j = 0; j < own.size(); ++j)
        if (is_in(there, own[j])) home[j] = from.get<double>();
    });
  }
}

template <int d>
double SharedDirect<d>::evaluation_bytes() const {
  return 8.0 * static_cast<double>(all_.sources) * (d + 3);
}

template class SharedSum<2>;
template class SharedSum<3>;
template class SharedDirect<2>;
template class SharedDirect<3>;

}  // namespace farfield::detail
