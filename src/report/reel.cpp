#include "report/reel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "gaussdrift/error.hpp"

namespace gaussdrift::report {

namespace {

using json = nlohmann::ordered_json;

constexpr std::string_view magic = "gdreel1\n";
constexpr std::size_t digits = 8, few_frames = 16;
constexpr std::size_t most_points = std::size_t{1} << 28;  // of a stream

/// Enough for a screen; in space, enough for a graphics card of a telephone.
std::size_t most_along(int dimension) { return dimension == 3 ? 64 : 512; }

std::size_t bytes_of(const ReelFrame& frame) {
  return std::accumulate(frame.streams.begin(), frame.streams.end(), std::size_t{0},
                         [](std::size_t sum, const Stream& stream) { return sum + stream.bytes.size(); });
}

json json_of(const Stream& stream, std::size_t at) {
  return {{"name", stream.name},         {"every", stream.every}, {"shape", stream.shape},
          {"min", stream.min},           {"max", stream.max},     {"at", at},
          {"bytes", stream.bytes.size()}};
}

Stream stream_from(const json& told, std::string_view body) {
  Stream stream{told.at("name"), told.at("every"), told.at("shape"), told.at("min"), told.at("max"), {}};
  const std::size_t at = told.at("at"), bytes = told.at("bytes");
  if (at > body.size() || bytes > body.size() - at) throw std::out_of_range("it is cut off");
  stream.bytes = body.substr(at, bytes);
  return stream;
}

void pass_stream(base::StateBytes& bytes, Stream& stream) {
  bytes(stream.name, stream.every, stream.shape, stream.min, stream.max, stream.bytes);
}

}  // namespace

Stream stream_on_grid(std::string name, const Lattice& lattice, const std::vector<double>& values, std::size_t every) {
  std::array<std::uint32_t, 3> shape;
  for (std::size_t k = 0; k < 3; ++k) shape[k] = static_cast<std::uint32_t>((lattice.points[k] + every - 1) / every);
  std::vector<double> kept;
  kept.reserve(std::size_t{shape[0]} * shape[1] * shape[2]);
  for (std::size_t z = 0; z < lattice.points[2]; z += every)
    for (std::size_t y = 0; y < lattice.points[1]; y += every)
      for (std::size_t x = 0; x < lattice.points[0]; x += every)
        kept.push_back(values[(z * lattice.points[1] + y) * lattice.points[0] + x]);
  return stream_of(std::move(name), static_cast<std::uint32_t>(every), shape, kept);
}

Stream Reel::on_grid(std::string name, const Lattice& lattice, const std::vector<double>& values) {
  if (every_point_ == 0) {
    const std::size_t longest = *std::max_element(lattice.points.begin(), lattice.points.end());
    const std::size_t most = most_along(lattice.dimension);
    lattice_ = lattice;
    every_point_ = std::max<std::size_t>(1, (longest + most - 2) / (most - 1));
  }
  return stream_on_grid(std::move(name), lattice, values, every_point_);
}

void Reel::add(ReelFrame frame) {
  // The last one before was kept because it was the last.
  if (!frames_.empty() && (frames_.back().output % every_output_ != 0 || frames_.back().output >= frame.output)) {
    bytes_ -= bytes_of(frames_.back());
    frames_.pop_back();
  }
  bytes_ += bytes_of(frame);
  frames_.push_back(std::move(frame));
  while (bytes_ > most_bytes_) {
    if (frames_.size() > few_frames) {
      every_output_ *= 2;
      const std::uint64_t last = frames_.back().output;
      std::erase_if(frames_,
                    [&](const ReelFrame& one) { return one.output % every_output_ != 0 && one.output != last; });
    } else {
      bool changed = false;
      for (ReelFrame& one : frames_)
        for (Stream& stream : one.streams)
          if (stream.every == every_point_ && stream.size() > 1) stream = coarser(stream), changed = true;
      if (!changed) break;  // particles alone
      every_point_ *= 2;
    }
    bytes_ = 0;
    for (const ReelFrame& one : frames_) bytes_ += bytes_of(one);
  }
}

void Reel::keep_first(std::size_t outputs) {
  std::erase_if(frames_, [&](const ReelFrame& frame) { return frame.output >= outputs; });
  bytes_ = 0;
  for (const ReelFrame& frame : frames_) bytes_ += bytes_of(frame);
}

void Reel::check() const {
  const auto wrong = [](const char* what) { throw std::out_of_range(what); };
  double points = 1;
  for (const std::size_t along : lattice_.points) points *= static_cast<double>(along);
  if (!frames_.empty() && !(lattice_.dimension >= 2 && lattice_.dimension <= 3 && points >= 1 && points <= 1e12 &&
                            lattice_.spacing > 0 && std::isfinite(lattice_.spacing)))
    wrong("its grid is wrong");
  if (every_output_ == 0) wrong("it has no frame");
  for (const ReelFrame& frame : frames_)
    for (const Stream& stream : frame.streams) {
      for (const std::uint32_t along : stream.shape)
        if (along == 0 || along > most_points) wrong("it has a stream of no shape");
      if (double(stream.shape[0]) * stream.shape[1] * stream.shape[2] > double(most_points))
        wrong("it has too large a stream");
      if (!std::isfinite(stream.min) || !std::isfinite(stream.max)) wrong("it has a stream of no range");
    }
}

void Reel::pass(base::StateBytes& bytes) {
  std::uint64_t every_output = every_output_, every_point = every_point_, count = frames_.size();
  bytes(every_output, every_point, lattice_.dimension, lattice_.points, lattice_.origin, lattice_.spacing, count);
  if (bytes.reading()) frames_.clear();
  for (std::uint64_t i = 0; i < count; ++i) {
    if (bytes.reading()) frames_.emplace_back();
    ReelFrame& frame = frames_[i];
    std::uint64_t streams = frame.streams.size();
    bytes(frame.output, frame.time, frame.date, streams);
    for (std::uint64_t k = 0; k < streams; ++k) {
      if (bytes.reading()) frame.streams.emplace_back();
      pass_stream(bytes, frame.streams[k]);
    }
  }
  if (!bytes.reading()) return;
  every_output_ = every_output, every_point_ = every_point;
  check();
  keep_first(static_cast<std::size_t>(-1));
}

DensityGrid Reel::density(const ReelFrame& frame, const std::string& name) const {
  const auto stream = std::find_if(frame.streams.begin(), frame.streams.end(),
                                   [&](const Stream& one) { return one.name == name && one.every > 0; });
  if (stream == frame.streams.end())
    throw FileError(fmt::format("{} has no {} of t = {:g}", reel_file, name, frame.time));
  Lattice coarse = lattice_;
  coarse.spacing *= stream->every;
  for (std::size_t k = 0; k < 3; ++k) coarse.points[k] = stream->shape[k];
  return {.lattice = coarse, .rho = values_of(*stream)};
}

std::string Reel::text() const {
  json frames = json::array();
  std::size_t at = 0;
  for (const ReelFrame& frame : frames_) {
    json streams = json::array();
    for (const Stream& stream : frame.streams) {
      streams.push_back(json_of(stream, at));
      at += stream.bytes.size();
    }
    frames.push_back({{"output", frame.output}, {"t", frame.time}, {"date", frame.date}, {"streams", streams}});
  }
  const json head{{"dimension", lattice_.dimension},
                  {"points", lattice_.points},
                  {"origin", lattice_.origin},
                  {"spacing", lattice_.spacing},
                  {"every_point", every_point_},
                  {"every_output", every_output_},
                  {"frames", frames}};
  const std::string told = head.dump(-1, ' ', true, json::error_handler_t::replace);
  std::string text = fmt::format("{}{:08x}\n{}", magic, told.size(), told);
  text.reserve(text.size() + at);
  for (const ReelFrame& frame : frames_)
    for (const Stream& stream : frame.streams) text += stream.bytes;
  return text;
}

Reel Reel::from_text(const std::string& text) {
  const std::string_view all = text;
  try {
    std::size_t length = 0;
    const std::size_t begin = magic.size() + digits + 1;
    if (!all.starts_with(magic) || all.size() < begin) throw std::out_of_range("it begins otherwise");
    const char* const number = all.data() + magic.size();
    if (std::from_chars(number, number + digits, length, 16).ptr != number + digits || length > all.size() - begin)
      throw std::out_of_range("it is cut off");
    const json head = json::parse(all.substr(begin, length));
    Reel reel(all.size());
    reel.lattice_ = {.dimension = head.at("dimension"),
                     .points = head.at("points"),
                     .origin = head.at("origin"),
                     .spacing = head.at("spacing")};
    reel.every_point_ = head.at("every_point"), reel.every_output_ = head.at("every_output");
    for (const json& told : head.at("frames")) {
      ReelFrame frame{told.at("output"), told.at("t"), told.at("date"), {}};
      for (const json& stream : told.at("streams"))
        frame.streams.push_back(stream_from(stream, all.substr(begin + length)));
      reel.frames_.push_back(std::move(frame));
    }
    reel.check();
    reel.keep_first(static_cast<std::size_t>(-1));
    return reel;
  } catch (const json::exception&) {
    throw FileError(fmt::format("{} is damaged: a member of its header is not what it should be", reel_file));
  } catch (const std::out_of_range& why) {
    throw FileError(fmt::format("{} is damaged: {}", reel_file, why.what()));
  }
}

}  // namespace gaussdrift::report
