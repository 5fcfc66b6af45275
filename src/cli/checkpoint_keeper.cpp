#include "cli/checkpoint_keeper.hpp"

#include <algorithm>
#include <utility>

namespace gaussdrift::cli {

namespace {

constexpr double usual_interval = 60;     // seconds
constexpr double least_part_of_run = 50;  // an interval is so many times as long as writing takes

}  // namespace

CheckpointKeeper::CheckpointKeeper(std::filesystem::path folder, std::function<std::string()> past,
                                   std::optional<double> asked, bool resumed, write::CheckpointWriter::Options options,
                                   write::CheckpointTrail trail, base::Communicator& ranks)
    : folder_(std::move(folder)),
      past_(std::move(past)),
      asked_(asked),
      resumed_(resumed),
      in_haste_(options.in_haste),
      ranks_(ranks),
      writer_(folder_, std::move(trail), std::move(options), ranks),
      on_disk_(!resumed) {}

bool CheckpointKeeper::is_due(const Progress& progress) const {
  const double since = since_last_.seconds();
  if (asked_) return *asked_ > 0 && since >= *asked_;
  if (since < std::max(usual_interval, least_part_of_run * last_seconds_)) return false;
  // The rest is taken to go on at the pace so far.
  const double done = progress.elapsed - begun_at_.value_or(0), left = progress.length - progress.elapsed;
  return done <= 0 || since_start_.seconds() * (1 + left / done) >= write::long_run;
}

bool CheckpointKeeper::is_time(const Progress& progress) {
  if (!begun_at_) begun_at_ = progress.elapsed;
  if (asked_ && *asked_ == 0) return false;
  const bool keeps_one = asked_ ? *asked_ > 0 : resumed_ || since_start_.seconds() >= write::long_run;
  return (keeps_one && progress.elapsed >= progress.length) || is_due(progress);
}

bool CheckpointKeeper::is_wanted(double time, std::size_t steps, std::size_t outputs) const {
  if (asked_ && *asked_ == 0) return false;
  return written_ == 0 || last_.time != time || last_.steps != steps || outputs_ != outputs;
}

void CheckpointKeeper::write(double time, std::size_t steps, std::size_t outputs, const Particles& particles,
                             const std::string& state) {
  const base::Stopwatch watch;
  ranks_.agree_on([&] {
    if (ranks_.rank() == 0 && hash_.empty()) hash_ = past_();
    force();  // the one that stays: the other is about to go
  });
  on_disk_ = false;
  last_ = writer_.write(hash_, time, steps, particles, state);
  on_disk_ = !in_haste_();
  outputs_ = outputs;
  last_seconds_ = watch.seconds();
  seconds_ += last_seconds_;
  ++written_;
  since_last_ = base::Stopwatch();
}

void CheckpointKeeper::force(const write::InHaste& in_haste) {
  if (!on_disk_) on_disk_ = write::force_checkpoints(folder_, in_haste, ranks_.rank(), ranks_.size());
}

}  // namespace gaussdrift::cli
