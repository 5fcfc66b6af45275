#include "cli/checkpoint_keeper.hpp"

#include <algorithm>
#include <utility>

namespace gaussdrift::cli {

namespace {

constexpr double usual_interval = 60;     // seconds
constexpr double least_part_of_run = 50;  // an interval is so many times as long as writing takes

}  // namespace

CheckpointKeeper::CheckpointKeeper(std::filesystem::path folder, std::function<std::string()> past,
                                   std::optional<double> asked, bool resumed)
    : folder_(std::move(folder)), past_(std::move(past)), asked_(asked), resumed_(resumed) {}

bool CheckpointKeeper::is_due(const Progress& progress) const {
  const double since = since_last_.seconds();
  if (asked_) return *asked_ > 0 && since >= *asked_;
  if (since < std::max(usual_interval, least_part_of_run * last_seconds_)) return false;
  // The rest is taken to go on at the pace so far.
  const double done = progress.time - begun_at_.value_or(0), left = progress.end - progress.time;
  return done <= 0 || since_start_.seconds() * (1 + left / done) >= write::long_run;
}

bool CheckpointKeeper::is_time(const Progress& progress) {
  if (!begun_at_) begun_at_ = progress.time;
  if (asked_ && *asked_ == 0) return false;
  const bool keeps_one = asked_ ? *asked_ > 0 : resumed_ || since_start_.seconds() >= write::long_run;
  return (keeps_one && progress.time >= progress.end) || is_due(progress);
}

void CheckpointKeeper::write(double time, std::size_t steps, const Particles& particles, const std::string& state) {
  if (asked_ && *asked_ == 0) return;
  const base::Stopwatch watch;
  if (hash_.empty()) hash_ = past_();
  last_ = write::write_checkpoint(folder_, hash_, time, steps, particles, state);
  last_seconds_ = watch.seconds();
  seconds_ += last_seconds_;
  ++written_;
  since_last_ = base::Stopwatch();
}

}  // namespace gaussdrift::cli
