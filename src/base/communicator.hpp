// What ranks say to each other. A run on N ranks is N copies of the program that talk through a Communicator. This class
// itself is the case of one rank: it needs no library, and nothing is sent. src/mpi has the one over MPI.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/seam.hpp"

namespace gaussdrift::base {

using Bytes = std::vector<std::byte>;

/// Bytes that exchange() moved to and from other ranks so far. What a rank keeps for itself does not count.
struct Traffic {
  std::uint64_t sent = 0, received = 0;
  std::uint64_t messages = 0;  // sent: one for each rank that was sent something, in each call
};

/// All functions but rank(), size(), hosts(), host(), traffic() and failed_together() are called by all ranks, in the same
/// order: a rank waits until the others have come. Results do not depend on who comes first. One thread of a rank calls
/// them. Where something is thrown on one rank alone, the others wait for it: see agree().
class Communicator {
 public:
  Communicator() = default;
  virtual ~Communicator() = default;
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  virtual int rank() const { return 0; }
  virtual int size() const { return 1; }
  /// Different machines that the ranks run on, and the number of this one among them, from 0.
  virtual int hosts() const { return 1; }
  virtual int host() const { return 0; }

  /// out[r] goes to rank r; what came from rank r is in result[r]. `out` has size() entries.
  std::vector<Bytes> exchange(std::vector<Bytes> out);
  /// Each number becomes the sum, or the maximum, of those of all ranks. All ranks bring equally many.
  virtual void sum(std::span<std::int64_t> numbers);
  virtual void max(std::span<std::int64_t> numbers);
  /// A NaN of any rank stays a NaN. 0 is larger than -0.
  void max(std::span<double> numbers);
  void min(std::span<double> numbers);
  /// Afterwards all ranks have the bytes of rank `from`.
  virtual void broadcast(Bytes& bytes, int from = 0);
  /// On rank 0: the bytes of all, by rank. Elsewhere nothing.
  std::vector<Bytes> gather(Bytes own);
  /// Nobody leaves before all have come.
  void barrier();

  /// Ends every phase of a run. Each rank says what went wrong with it; null: nothing. If something did, all throw the
  /// error of the lowest rank that has one. An Error keeps its words and its exit code. Lack of memory and faults of the
  /// program are told with the rank. Work that was abandoned on one rank counts as abandoned on all, unless another has an
  /// error: then all throw Abandoned.
  void agree(const std::exception_ptr& trouble);
  /// Does `work`, which must not communicate, and agrees on how it went.
  template <class Work>
  void agree_on(const Work& work);
  /// Whether all ranks threw this error together, in agree(). Any other has to end the other ranks by force.
  bool failed_together(const std::exception_ptr& error) const { return error && error == agreed_; }

  const Traffic& traffic() const { return traffic_; }

 protected:
  /// The same as exchange(), with out.size() == size().
  virtual std::vector<Bytes> deliver(std::vector<Bytes> out);

 private:
  friend class AbandonableTogether;

  const AbandonWanted* abandon_wanted_ = nullptr;  // inside agree_on()
  std::exception_ptr agreed_;
  Traffic traffic_;
};

template <class Work>
void Communicator::agree_on(const Work& work) {
  std::exception_ptr trouble;
  try {
    std::optional<Abandonable> while_it_lasts;
    if (abandon_wanted_) while_it_lasts.emplace(abandon_wanted_);
    work();
  } catch (...) {
    trouble = std::current_exception();
  }
  agree(trouble);
}

/// While it lives, what ranks do together may be abandoned: one rank's part of it in agree_on(), at its seams, and then
/// all throw Abandoned. Between two calls of agree_on() nothing is abandoned, because other ranks wait for what is sent.
/// On one rank it is an Abandonable.
class AbandonableTogether {
 public:
  AbandonableTogether(Communicator& ranks, const AbandonWanted* wanted)
      : ranks_(ranks), before_(ranks.abandon_wanted_) {
    if (ranks.size() == 1)
      alone_.emplace(wanted);
    else
      ranks_.abandon_wanted_ = wanted;
  }
  ~AbandonableTogether() { ranks_.abandon_wanted_ = before_; }
  AbandonableTogether(const AbandonableTogether&) = delete;
  AbandonableTogether& operator=(const AbandonableTogether&) = delete;

 private:
  Communicator& ranks_;
  const AbandonWanted* before_;
  std::optional<Abandonable> alone_;
};

/// Values as bytes, to be sent among ranks of the same kind of machine.
template <class Value>
Bytes to_bytes(std::span<const Value> values) {
  static_assert(std::is_trivially_copyable_v<Value>);
  Bytes bytes(values.size_bytes());
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}
template <class Value>
Bytes to_bytes(const std::vector<Value>& values) {
  return to_bytes(std::span<const Value>(values));
}

inline Bytes to_bytes(std::string_view text) { return to_bytes(std::span<const char>(text)); }
inline Bytes to_bytes(const std::string& text) { return to_bytes(std::string_view(text)); }

/// The text whose bytes these are.
inline std::string to_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The values whose bytes these are.
template <class Value>
std::vector<Value> from_bytes(std::span<const std::byte> bytes) {
  static_assert(std::is_trivially_copyable_v<Value>);
  std::vector<Value> values(bytes.size() / sizeof(Value));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Value));
  return values;
}

}  // namespace gaussdrift::base
