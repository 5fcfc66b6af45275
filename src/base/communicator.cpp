#include "base/communicator.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "gaussdrift/error.hpp"

namespace gaussdrift::base {

namespace {

/// Whole numbers in the order of the doubles, from -inf to inf. All NaN become the largest, which is above inf.
std::int64_t place_in_order(double number) {
  if (std::isnan(number)) return std::numeric_limits<std::int64_t>::max();
  const auto bits = std::bit_cast<std::int64_t>(number);
  return bits >= 0 ? bits : bits ^ std::numeric_limits<std::int64_t>::max();
}

double at_place(std::int64_t place) {
  if (place == std::numeric_limits<std::int64_t>::max()) return std::numeric_limits<double>::quiet_NaN();
  return std::bit_cast<double>(place >= 0 ? place : place ^ std::numeric_limits<std::int64_t>::max());
}

/// An error on its way to other ranks: a byte for its exit code, then its words.
Bytes told(ExitCode code, const std::string& words) {
  Bytes bytes = to_bytes(words);
  bytes.insert(bytes.begin(), static_cast<std::byte>(code));
  return bytes;
}

Bytes told(const std::exception_ptr& trouble, int rank, int size) {
  const std::string who = "rank " + std::to_string(rank) + " of " + std::to_string(size);
  try {
    std::rethrow_exception(trouble);
  } catch (const Error& error) {
    return told(error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return told(ExitCode::input,
                who + " is out of memory; lower particles.per_axis or evaluate.per_axis, or start more ranks");
  } catch (const std::exception& error) {
    return told(ExitCode::internal, who + ": " + error.what());
  } catch (...) {
    return told(ExitCode::internal, who + ": something unknown was thrown");
  }
}

std::exception_ptr error_of(const Bytes& bytes) {
  const std::string words = to_text(std::span(bytes).subspan(1));
  switch (const auto code = static_cast<ExitCode>(bytes[0])) {
    case ExitCode::internal:
      return std::make_exception_ptr(std::runtime_error(words));
    case ExitCode::command_line:
      return std::make_exception_ptr(CommandLineError(words));
    case ExitCode::input:
      return std::make_exception_ptr(InputError(words));
    case ExitCode::numerical:
      return std::make_exception_ptr(NumericalError(words));
    case ExitCode::files:
      return std::make_exception_ptr(FileError(words));
    default:
      return std::make_exception_ptr(Error(code, words));
  }
}

bool is_for_the_user(const std::exception_ptr& trouble) {
  try {
    std::rethrow_exception(trouble);
  } catch (const Error&) {
    return true;
  } catch (...) {
    return false;
  }
}

bool is_abandoned(const std::exception_ptr& trouble) {
  try {
    std::rethrow_exception(trouble);
  } catch (const Abandoned&) {
    return true;
  } catch (...) {
    return false;
  }
}

}  // namespace

void Communicator::sum(std::span<std::int64_t>) {}
void Communicator::max(std::span<std::int64_t>) {}
void Communicator::broadcast(Bytes&, int) {}
std::vector<Bytes> Communicator::deliver(std::vector<Bytes> out) { return out; }

std::vector<Bytes> Communicator::exchange(std::vector<Bytes> out) {
  const auto ranks = static_cast<std::size_t>(size()), own = static_cast<std::size_t>(rank());
  if (out.size() != ranks)
    throw std::logic_error("exchange: bytes for " + std::to_string(out.size()) + " ranks of " + std::to_string(ranks));
  for (std::size_t r = 0; r < ranks; ++r) {
    if (r == own) continue;
    traffic_.sent += out[r].size();
    traffic_.messages += out[r].empty() ? 0 : 1;
  }
  std::vector<Bytes> in = deliver(std::move(out));
  for (std::size_t r = 0; r < ranks; ++r) traffic_.received += r == own ? 0 : in[r].size();
  return in;
}

void Communicator::max(std::span<double> numbers) {
  std::vector<std::int64_t> places(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) places[i] = place_in_order(numbers[i]);
  max(std::span(places));
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = at_place(places[i]);
}

void Communicator::min(std::span<double> numbers) {
  for (double& number : numbers) number = -number;
  max(numbers);
  for (double& number : numbers) number = -number;
}

std::vector<Bytes> Communicator::gather(Bytes own) {
  std::vector<Bytes> out(static_cast<std::size_t>(size()));
  out[0] = std::move(own);
  std::vector<Bytes> in = exchange(std::move(out));
  if (rank() != 0) in.clear();
  return in;
}

void Communicator::barrier() {
  std::int64_t nothing = 0;  // a sum needs everybody
  sum(std::span(&nothing, 1));
}

void Communicator::agree(const std::exception_ptr& trouble) {
  agreed_ = nullptr;
  constexpr std::int64_t none = 0, abandoned = 1;
  std::int64_t first = none;
  if (trouble) first = is_abandoned(trouble) ? abandoned : abandoned + size() - rank();  // largest for the lowest rank
  max(std::span(&first, 1));
  if (first == none) return;
  if (first == abandoned) throw Abandoned{};
  const int from = size() - static_cast<int>(first - abandoned);
  if (size() == 1) {
    agreed_ = trouble;
  } else {
    Bytes words;
    if (from == rank()) words = told(trouble, rank(), size());
    broadcast(words, from);
    // On its own rank it stays the object that it was: it may know more than its words.
    agreed_ = from == rank() && is_for_the_user(trouble) ? trouble : error_of(words);
  }
  std::rethrow_exception(agreed_);
}

}  // namespace gaussdrift::base
