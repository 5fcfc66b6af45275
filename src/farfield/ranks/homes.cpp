#include "farfield/ranks/homes.hpp"

#include <algorithm>

namespace farfield::detail {
namespace {

/// A point that has come from another rank.
struct Arrival {
  std::uint32_t leaf;
  Index arrival;
  std::int64_t number;
};

/// What has come from all ranks, in the order of arrival; arrived[r]: the first of rank r.
std::vector<Arrival> read_arrivals(std::vector<Reader>& from, std::vector<std::size_t>& arrived) {
  std::vector<Arrival> arrivals;
  arrived = {0};
  for (Reader& reader : from) {
    const auto leaves = reader.get_list<std::uint64_t>();
    for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf)
      for (std::uint64_t i = 0; i < leaves[leaf]; ++i)
        arrivals.push_back(
            {static_cast<std::uint32_t>(leaf), static_cast<Index>(arrivals.size()), reader.get<std::int64_t>()});
    arrived.push_back(arrivals.size());
  }
  return arrivals;
}

void refuse_equal_numbers(const std::vector<Arrival>& sorted) {
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i - 1].leaf == sorted[i].leaf && sorted[i - 1].number == sorted[i].number)
      throw InvalidArgument("farfield: two points have the number " + std::to_string(sorted[i].number) +
                            "; the numbers of all points of all ranks must differ");
}

}  // namespace

template <int d>
Homes<d>::Homes(const Channel& channel, const CoarseTree& coarse, const SortedPoints& points,
                const std::vector<Range>& here, std::span<const std::int64_t> numbers, SortedPoints& own,
                double& received) {
  const std::size_t ranks = channel.size();
  std::vector<std::vector<std::uint64_t>> counts(ranks);  // by owner: points of this rank in each of its leaves
  for (std::size_t i = 0; i < here.size(); ++i)
    if (coarse.points() > 0)
      counts[coarse.owner(coarse.clusters[coarse.leaves[i]].sources.begin)].push_back(here[i].end - here[i].begin);
  std::vector<Bytes> out(ranks);
  sent_ = points.original;
  sent_to_ = {0};
  for (std::size_t r = 0; r < ranks; ++r) {
    const std::size_t begin = sent_to_.back();
    std::size_t end = begin;
    for (const std::uint64_t count : counts[r]) end += count;
    sent_to_.push_back(end);
    Writer to;
    to.put_list(counts[r]);
    for (std::size_t i = begin; i < end; ++i) to.put(numbers[sent_[i]]);
    for (std::size_t l = 0; l < d; ++l) to.put(points.position[l].data() + begin, end - begin);
    out[r] = to.take();
  }
  const std::vector<Bytes> in = channel.exchange(std::move(out), received);

  std::vector<Reader> readers(in.begin(), in.end());
  std::vector<Arrival> arrivals = read_arrivals(readers, arrived_);
  std::sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) {
    return a.leaf != b.leaf ? a.leaf < b.leaf : a.number < b.number;
  });
  channel.together([&] { refuse_equal_numbers(arrivals); });

  own.original.resize(arrivals.size());
  for (std::size_t i = 0; i < arrivals.size(); ++i) own.original[i] = arrivals[i].arrival;
  std::vector<double> column(arrivals.size());
  for (std::size_t l = 0; l < d; ++l) {
    for (std::size_t r = 0; r < ranks; ++r) readers[r].get(column.data() + arrived_[r], arrived_[r + 1] - arrived_[r]);
    own.position[l].assign(arrivals.size() + padding, 0.0);
    for (std::size_t i = 0; i < arrivals.size(); ++i) own.position[l][i] = column[own.original[i]];
  }
}

template <int d>
Buffer<double> Homes<d>::charges_here(const Channel& channel, const Buffer<double>& charges) const {
  std::vector<Bytes> out(channel.size());
  for (std::size_t r = 0; r < out.size(); ++r) {
    Writer to;
    for (std::size_t i = sent_to_[r]; i < sent_to_[r + 1]; ++i) to.put(charges[sent_[i]]);
    out[r] = to.take();
  }
  const std::vector<Bytes> in = channel.exchange(std::move(out));
  Buffer<double> here;
  here.assign(arrived() + padding, 0.0);
  for (std::size_t r = 0; r < in.size(); ++r)
    Reader(in[r]).get(here.data() + arrived_[r], arrived_[r + 1] - arrived_[r]);
  return here;
}

template <int d>
void Homes<d>::results_home(const Channel& channel, const Sums& here, bool potential, Sums& at_home) const {
  const auto for_each_column = [&](const auto& use) {
    if (potential) use(here.potential, at_home.potential);
    for (std::size_t l = 0; l < d; ++l) use(here.field[l], at_home.field[l]);
  };
  std::vector<Bytes> out(channel.size());
  for (std::size_t r = 0; r < out.size(); ++r) {
    Writer to;
    for_each_column([&](const Buffer<double>& column, const Buffer<double>&) {
      to.put(column.data() + arrived_[r], arrived_[r + 1] - arrived_[r]);
    });
    out[r] = to.take();
  }
  const std::vector<Bytes> in = channel.exchange(std::move(out));
  std::vector<double> some;
  for (std::size_t r = 0; r < in.size(); ++r) {
    Reader from(in[r]);
    some.resize(sent_to_[r + 1] - sent_to_[r]);
    for_each_column([&](const Buffer<double>&, Buffer<double>& home) {
      from.get(some.data(), some.size());
      for (std::size_t i = 0; i < some.size(); ++i) home[sent_[sent_to_[r] + i]] = some[i];
    });
  }
}

template <int d>
double Homes<d>::received(std::size_t rank, bool potential) const {
  const std::size_t guests = arrived() - (arrived_[rank + 1] - arrived_[rank]),
                    away = sent_.size() - (sent_to_[rank + 1] - sent_to_[rank]), columns = d + potential;
  return sizeof(double) * static_cast<double>(guests + away * columns);
}

template class Homes<2>;
template class Homes<3>;

}  // namespace farfield::detail
