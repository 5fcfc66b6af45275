// Ranks over MPI, in a shared library of its own.
#include <mpi.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <set>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "mpi/mpi_module.hpp"

namespace gaussdrift::mpi {

namespace {

using base::Bytes;

constexpr int data_tag = 1, first_size_tag = 2;
constexpr std::size_t most_numbers = std::size_t{1} << 24;  // in one call of MPI, whose counts have 32 bits

bool running = false;

/// A rank that waits for others to finish their work gives its processor away: MPI itself would keep it busy. The wait
/// gets longer by a tenth at most, and by a millisecond.
class Patience {
 public:
  void pause() const {
    constexpr auto busy = std::chrono::microseconds(200), longest = std::chrono::microseconds(1000);
    const auto waited = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - begun_);
    if (waited < busy)
      sched_yield();
    else
      std::this_thread::sleep_for(std::min(longest, waited / 10));
  }

 private:
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begun_ = Clock::now();
};

void wait_for(MPI_Request request) {
  const Patience patience;
  for (int done = 0;;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done) return;
    patience.pause();
  }
}

class MpiRanks : public base::Communicator {
 public:
  explicit MpiRanks(const Exchange& how) : how_(how) {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    running = true;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    find_hosts();
  }
  ~MpiRanks() override {
    running = false;
    MPI_Finalize();
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int hosts() const override { return hosts_; }
  int host() const override { return host_; }

  using Communicator::max;
  void sum(std::span<std::int64_t> numbers) override { combine(numbers, MPI_SUM); }
  void max(std::span<std::int64_t> numbers) override { combine(numbers, MPI_MAX); }

  void broadcast(Bytes& bytes, int from) override {
    std::uint64_t size = bytes.size();
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibcast(&size, 1, MPI_UINT64_T, from, MPI_COMM_WORLD, &request);
    wait_for(request);
    bytes.resize(size);
    for (std::size_t at = 0; at < size; at += how_.round) {
      const auto count = static_cast<int>(std::min<std::size_t>(how_.round, size - at));
      MPI_Ibcast(bytes.data() + at, count, MPI_BYTE, from, MPI_COMM_WORLD, &request);
      wait_for(request);
    }
  }

 protected:
  std::vector<Bytes> deliver(std::vector<Bytes> out) override {
    const auto own = static_cast<std::size_t>(rank_);
    const std::vector<std::uint64_t> sizes =
        size_ <= how_.told_by_all ? sizes_told_by_all(out) : sizes_told_by_few(out);
    std::vector<Bytes> in(out.size());
    std::uint64_t longest = 0;
    for (std::size_t r = 0; r < in.size(); ++r) {
      if (r == own) continue;
      in[r].resize(sizes[r]);
      longest = std::max({longest, sizes[r], static_cast<std::uint64_t>(out[r].size())});
    }
    // Round k has the k-th piece of each pair, so two ranks agree on it without asking.
    const std::size_t piece = std::max<std::size_t>(1, how_.round / out.size());
    for (std::size_t at = 0; at < longest; at += piece) move_pieces(out, in, at, piece);
    in[own] = std::move(out[own]);
    return in;
  }

 private:
  /// The machines are told apart by their names.
  void find_hosts() {
    using Name = std::array<char, MPI_MAX_PROCESSOR_NAME>;
    Name own{};
    int length = 0;
    MPI_Get_processor_name(own.data(), &length);
    std::vector<Name> names(static_cast<std::size_t>(size_));
    MPI_Allgather(own.data(), MPI_MAX_PROCESSOR_NAME, MPI_CHAR, names.data(), MPI_MAX_PROCESSOR_NAME, MPI_CHAR,
                  MPI_COMM_WORLD);
    const std::set<Name> different(names.begin(), names.end());
    hosts_ = static_cast<int>(different.size());
    host_ = static_cast<int>(std::distance(different.begin(), different.find(own)));
  }

  void combine(std::span<std::int64_t> numbers, MPI_Op operation) {
    std::size_t at = 0;
    do {  // also for no numbers: nobody leaves before all have come
      const std::size_t count = std::min(most_numbers, numbers.size() - at);
      MPI_Request request = MPI_REQUEST_NULL;
      MPI_Iallreduce(MPI_IN_PLACE, numbers.data() + at, static_cast<int>(count), MPI_INT64_T, operation, MPI_COMM_WORLD,
                     &request);
      wait_for(request);
      at += count;
    } while (at < numbers.size());
  }

  /// How many bytes will come from each rank. Here nearly all of the time is spent in which ranks wait for each other.
  std::vector<std::uint64_t> sizes_told_by_all(const std::vector<Bytes>& out) const {
    std::vector<std::uint64_t> to, from(out.size());
    for (const Bytes& bytes : out) to.push_back(bytes.size());
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ialltoall(to.data(), 1, MPI_UINT64_T, from.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD, &request);
    wait_for(request);
    return from;
  }

  /// The same where most ranks have nothing for most others: whoever has something tells it. A message counts as sent
  /// when it was received, and when that is so for all ranks, no more will come.
  std::vector<std::uint64_t> sizes_told_by_few(const std::vector<Bytes>& out) {
    // The next call has another tag: ranks that see the end of this one early are there already.
    size_tag_ = size_tag_ == first_size_tag ? first_size_tag + 1 : first_size_tag;
    std::vector<std::uint64_t> to, from(out.size());
    for (const Bytes& bytes : out) to.push_back(bytes.size());
    std::vector<MPI_Request> telling;
    for (int r = 0; r < size_; ++r)
      if (r != rank_ && to[static_cast<std::size_t>(r)] > 0)
        MPI_Issend(&to[static_cast<std::size_t>(r)], 1, MPI_UINT64_T, r, size_tag_, MPI_COMM_WORLD,
                   &telling.emplace_back(MPI_REQUEST_NULL));
    MPI_Request all_told = MPI_REQUEST_NULL;
    const Patience patience;
    for (bool told = false;;) {
      int there = 0, done = 0;
      MPI_Status status;
      MPI_Iprobe(MPI_ANY_SOURCE, size_tag_, MPI_COMM_WORLD, &there, &status);
      if (there) {
        MPI_Recv(&from[static_cast<std::size_t>(status.MPI_SOURCE)], 1, MPI_UINT64_T, status.MPI_SOURCE, size_tag_,
                 MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        continue;
      }
      if (told) {
        MPI_Test(&all_told, &done, MPI_STATUS_IGNORE);
        if (done) return from;
      } else {
        MPI_Testall(static_cast<int>(telling.size()), telling.data(), &done, MPI_STATUSES_IGNORE);
        if (done) MPI_Ibarrier(MPI_COMM_WORLD, &all_told);
        told = done;
      }
      patience.pause();
    }
  }

  void move_pieces(const std::vector<Bytes>& out, std::vector<Bytes>& in, std::size_t at, std::size_t piece) const {
    std::vector<MPI_Request> moving;
    const auto count = [&](const Bytes& bytes) { return static_cast<int>(std::min(piece, bytes.size() - at)); };
    for (int r = 0; r < size_; ++r) {
      Bytes& bytes = in[static_cast<std::size_t>(r)];
      if (r != rank_ && at < bytes.size())
        MPI_Irecv(bytes.data() + at, count(bytes), MPI_BYTE, r, data_tag, MPI_COMM_WORLD,
                  &moving.emplace_back(MPI_REQUEST_NULL));
    }
    for (int step = 1; step < size_; ++step) {  // not all to rank 0 first
      const int r = (rank_ + step) % size_;
      const Bytes& bytes = out[static_cast<std::size_t>(r)];
      if (at < bytes.size())
        MPI_Isend(bytes.data() + at, count(bytes), MPI_BYTE, r, data_tag, MPI_COMM_WORLD,
                  &moving.emplace_back(MPI_REQUEST_NULL));
    }
    // All have come, and bytes move only while MPI is called: no sleep.
    MPI_Waitall(static_cast<int>(moving.size()), moving.data(), MPI_STATUSES_IGNORE);
  }

  const Exchange how_;
  int rank_ = 0, size_ = 1, hosts_ = 1, host_ = 0, size_tag_ = first_size_tag;
};

std::unique_ptr<base::Communicator> start_ranks(const Exchange& how) { return std::make_unique<MpiRanks>(how); }

void end_all_ranks(int code) {
  if (running) MPI_Abort(MPI_COMM_WORLD, code);
}

}  // namespace
}  // namespace gaussdrift::mpi

/// What the program asks for.
extern "C" const gaussdrift::mpi::MpiModule* gaussdrift_mpi_ranks() {
  static const gaussdrift::mpi::MpiModule functions{gaussdrift::mpi::start_ranks, gaussdrift::mpi::end_all_ranks};
  return &functions;
}
