#include "write/checkpoint.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zlib.h>

#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "gaussdrift/error.hpp"
#include "same_particles.hpp"
#include "scratch_folder.hpp"
#include "sim/run_state.hpp"
#include "write/disk.hpp"

namespace gaussdrift::write {
namespace {

namespace fs = std::filesystem;

Particles some_particles(std::size_t count, double first) {
  Particles particles;
  for (std::size_t j = 0; j < count; ++j) {
    particles.position[0].push_back(first + 0.1 * static_cast<double>(j));
    particles.position[1].push_back(-static_cast<double>(j));
    particles.alpha.push_back(1.0 / static_cast<double>(j + 3));
    particles.id.push_back(static_cast<std::int64_t>(count - j) - 2);
  }
  particles.path.assign(1, std::vector<double>(count, 0.25));
  particles.volume.assign(count, 0.5);
  particles.spread = 0.1;
  return particles;
}

/// What Simulation::state() would say.
std::string state_of(std::string run, std::vector<std::string> outputs = {}) {
  RunState parts{.run = std::move(run), .outputs = std::move(outputs)};
  return joined(parts);
}

base::Communicator alone;

CheckpointWriter writer_to(const ScratchFolder& folder, CheckpointWriter::Options options = {}) {
  return {folder.path(), {}, std::move(options), alone};
}

/// Two of them: of 5 particles and an output at t = 1, then of 3 and another output at t = 2.
class TwoCheckpoints : public testing::Test {
 protected:
  TwoCheckpoints() {
    writer.write("hash", 1, 10, older, state_of("first", {"one"}));
    writer.write("hash", 2, 20, newer, state_of(std::string("sec\0nd", 6), {"one", "two"}));
  }
  std::optional<Checkpoint> read(const std::string& past = "hash") {
    refused.clear();
    return read_checkpoint(folder.path(), past, refused, alone);
  }
  void write_third_in_haste() {
    CheckpointWriter hasty(folder.path(), read()->trail, {.in_haste = always}, alone);
    hasty.write("hash", 3, 30, some_particles(7, 1), state_of("third", {"one", "two"}));
  }
  const ScratchFolder folder;
  const InHaste always = [] { return true; };
  CheckpointWriter writer = writer_to(folder);
  const Particles older = some_particles(5, 0), newer = some_particles(3, 7);
  std::vector<std::string> refused;
};

TEST_F(TwoCheckpoints, TheNewerCountsWithAllItsBits) {
  const auto checkpoint = read();
  ASSERT_TRUE(checkpoint);
  EXPECT_EQ(checkpoint->facts.time, 2);
  EXPECT_EQ(checkpoint->facts.steps, 20u);
  EXPECT_EQ(checkpoint->state, state_of(std::string("sec\0nd", 6), {"one", "two"}));
  EXPECT_EQ(checkpoint->facts.bytes, 8 * 3 * 6 + 6);
  expect_same(checkpoint->particles, newer);
  EXPECT_TRUE(refused.empty());
}

TEST_F(TwoCheckpoints, AThirdTakesThePlaceOfTheOlder) {
  writer.write("hash", 3, 30, some_particles(2, 1), state_of("third", {"one", "two", "three"}));
  EXPECT_EQ(read()->facts.time, 3);
  EXPECT_EQ(read()->state, state_of("third", {"one", "two", "three"}));
  fs::remove(folder / "state/0/manifest.json");
  EXPECT_EQ(read()->facts.time, 2);
  EXPECT_EQ(read()->state, state_of(std::string("sec\0nd", 6), {"one", "two"}));
}

/// The one that the run goes on from is kept, not the one that calls itself newer.
TEST_F(TwoCheckpoints, TheNextOneReplacesADamagedOne) {
  write_file(folder / "state/1/particles_0000.raw", "damaged");
  auto checkpoint = read();
  EXPECT_EQ(checkpoint->facts.time, 1);
  CheckpointWriter next(folder.path(), checkpoint->trail, {}, alone);
  next.write("hash", 1.5, 15, some_particles(2, 1), state_of("next", {"one", "other"}));
  EXPECT_EQ(read()->facts.time, 1.5);
  EXPECT_EQ(read()->state, state_of("next", {"one", "other"}));
  fs::remove(folder / "state/1/manifest.json");
  EXPECT_EQ(read()->facts.time, 1);
  EXPECT_EQ(read()->state, state_of("first", {"one"}));
}

/// Of a process that was killed while it wrote.
TEST_F(TwoCheckpoints, ATornEndOfTheOutputsIsOfNobody) {
  const std::string whole = read_file(folder / "state/outputs.raw");
  write_file(folder / "state/outputs.raw", whole + "torn");
  auto checkpoint = read();
  EXPECT_EQ(checkpoint->state, state_of(std::string("sec\0nd", 6), {"one", "two"}));
  CheckpointWriter next(folder.path(), checkpoint->trail, {}, alone);
  next.write("hash", 3, 30, newer, state_of("third", {"one", "two"}));
  EXPECT_EQ(read_file(folder / "state/outputs.raw"), whole);
  EXPECT_EQ(read()->facts.time, 3);
}

/// The last output is shown again by a run that goes on from its end, and takes other seconds.
TEST_F(TwoCheckpoints, AnOutputThatIsShownAgainReplacesTheEarlierOne) {
  CheckpointWriter next(folder.path(), read()->trail, {}, alone);
  next.write("hash", 3, 30, newer, state_of("without", {"one"}));
  EXPECT_EQ(read()->state, state_of("without", {"one"}));
  next.write("hash", 3, 31, newer, state_of("again", {"one", "TWO", "three"}));
  EXPECT_EQ(read()->state, state_of("again", {"one", "TWO", "three"}));
  fs::remove(folder / "state/1/manifest.json");
  EXPECT_EQ(read()->state, state_of("without", {"one"}));
}

TEST_F(TwoCheckpoints, OutputsThatAreGoneAreWrittenAgain) {
  fs::remove(folder / "state/outputs.raw");
  EXPECT_FALSE(read());
  EXPECT_NE(refused.at(0).find("outputs.raw is missing"), std::string::npos) << refused[0];
  writer.write("hash", 3, 30, newer, state_of("third", {"one", "two"}));
  EXPECT_EQ(read()->state, state_of("third", {"one", "two"}));
}

TEST_F(TwoCheckpoints, DamagedOutputsAreRefused) {
  const fs::path file = folder / "state/outputs.raw";
  const std::string whole = read_file(file);
  std::string damaged = whole;
  damaged.back() = '?';
  write_file(file, damaged);
  EXPECT_EQ(read()->facts.time, 1) << "which needs the first row alone";
  EXPECT_NE(refused.at(0).find("outputs.raw is damaged: its check sum is wrong"), std::string::npos) << refused[0];
  write_file(file, whole.substr(0, whole.size() - 1));
  EXPECT_EQ(read()->facts.time, 1);
  EXPECT_NE(refused.at(0).find("bytes, must have"), std::string::npos) << refused[0];
}

TEST(Checkpoints, OfManyOutputsWriteEachOfThemOnce) {
  std::vector<std::uintmax_t> bytes;
  for (const std::size_t outputs : {50u, 100u, 200u}) {
    const ScratchFolder folder;
    CheckpointWriter writer = writer_to(folder, {.in_haste = [] { return true; }});  // the disk is slow
    std::vector<std::string> rows;
    std::uintmax_t written = 0, log = 0;
    for (std::size_t i = 0; i < outputs; ++i) {
      rows.push_back(std::string(200, 'x') + std::to_string(i));
      writer.write("hash", static_cast<double>(i), i, some_particles(2, 0), state_of("run", rows));
      for (const auto& entry : fs::directory_iterator(folder / ("state/" + std::to_string(i % 2))))
        written += entry.file_size();
      const std::uintmax_t grown = fs::file_size(folder / "state/outputs.raw");
      written += grown - log, log = grown;
    }
    bytes.push_back(written);
  }
  EXPECT_NEAR(static_cast<double>(bytes[1]) / static_cast<double>(bytes[0]), 2, 0.05);
  EXPECT_NEAR(static_cast<double>(bytes[2]) / static_cast<double>(bytes[1]), 2, 0.05);
}

/// The system has the files, so it is whole when the process ends.
TEST_F(TwoCheckpoints, OneInHasteIsWhole) {
  write_third_in_haste();
  EXPECT_FALSE(force_checkpoints(folder.path(), always));
  EXPECT_EQ(read()->facts.time, 3);
  expect_same(read()->particles, some_particles(7, 1));
  EXPECT_TRUE(force_checkpoints(folder.path()));
}

/// What a file system may have of it after a loss of power: a name with nothing behind it, or with zeros.
TEST_F(TwoCheckpoints, OneInHasteThatLostItsPowerIsRefusedAndTheOlderTaken) {
  write_third_in_haste();
  for (const char* name : {"manifest.json", "particles_0000.raw", "run.raw"}) {
    const fs::path file = folder / "state/0" / name;
    const std::string whole = read_file(file);
    for (const std::string& left : {std::string(), std::string(whole.size(), '\0')}) {
      std::ofstream(file, std::ios::binary) << left;
      EXPECT_EQ(read()->facts.time, 2) << name;
      EXPECT_EQ(refused.size(), 1u);
    }
    std::ofstream(file, std::ios::binary) << whole;
    EXPECT_EQ(read()->facts.time, 3) << name;
  }
}

/// A stranger's folder may have a pipe or a link there; nobody waits for it.
TEST_F(TwoCheckpoints, OnlyFilesAreForcedToTheDisk) {
  fs::remove(folder / "state/0/run.raw");
  fs::create_symlink("nowhere", folder / "state/0/run.raw");
  ASSERT_EQ(mkfifo((folder / "state/0/particles_0001.raw").c_str(), 0600), 0);
  EXPECT_TRUE(force_checkpoints(folder.path()));
}

TEST(LargeCheckpoint, HasTheSameFilesFromAnyNumberOfThreads) {
  const ScratchFolder one, two;
  Particles particles;
  constexpr std::size_t count = (std::size_t{1} << 20) + 5;  // in two pieces
  particles.dimension = 1;
  for (std::size_t j = 0; j < count; ++j) particles.position[0].push_back(static_cast<double>(j));
  particles.alpha.assign(count, 0.5);
  particles.id.assign(count, 1);
  writer_to(one).write("hash", 1, 10, particles, state_of(""));
  writer_to(two, {.threads = 2}).write("hash", 1, 10, particles, state_of(""));
  for (const char* name : {"manifest.json", "particles_0000.raw", "particles_0001.raw", "run.raw"})
    EXPECT_TRUE(read_file(one / "state/0" / name) == read_file(two / "state/0" / name)) << name;
  std::vector<std::string> refused;
  expect_same(read_checkpoint(two.path(), "hash", refused, alone)->particles, particles);
}

TEST_F(TwoCheckpoints, WhatIsDamagedIsRefusedAndTheOlderTaken) {
  for (const char* file : {"state/1/particles_0000.raw", "state/1/run.raw"}) {
    const std::string whole = read_file(folder / file);
    for (std::size_t at = 0; at < whole.size(); ++at) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ 1);
      std::ofstream(folder / file, std::ios::binary) << damaged;
      const auto checkpoint = read();
      ASSERT_TRUE(checkpoint);
      ASSERT_EQ(checkpoint->facts.time, 1) << file << " byte " << at;
      expect_same(checkpoint->particles, older);
      ASSERT_EQ(refused.size(), 1u);
      ASSERT_NE(refused[0].find("check sum"), std::string::npos) << refused[0];
    }
    std::ofstream(folder / file, std::ios::binary) << whole.substr(1);
    EXPECT_EQ(read()->facts.time, 1);
    EXPECT_NE(refused[0].find("bytes, must have"), std::string::npos) << refused[0];
    fs::remove(folder / file);
    EXPECT_EQ(read()->facts.time, 1);
    EXPECT_NE(refused[0].find("is missing"), std::string::npos) << refused[0];
    std::ofstream(folder / file, std::ios::binary) << whole;
    EXPECT_EQ(read()->facts.time, 2);
  }
}

TEST_F(TwoCheckpoints, AManifestWithAnyOneByteWrongIsNeverACrash) {
  const fs::path file = folder / "state/1/manifest.json";
  const std::string whole = read_file(file);
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const char wrong : {'9', '}', '\0'}) {
      std::string damaged = whole;
      damaged[at] = wrong;
      std::ofstream(file, std::ios::binary) << damaged;
      const auto checkpoint = read();
      ASSERT_TRUE(checkpoint) << at << wrong;
      const bool space = whole[at] == ' ' || whole[at] == '\n';
      if (damaged != whole && !space) {
        EXPECT_EQ(checkpoint->facts.time, 1) << at << wrong;
      }
    }
  for (std::size_t length = 0; length < whole.size(); ++length) {
    std::ofstream(file, std::ios::binary) << whole.substr(0, length);
    const auto checkpoint = read();
    ASSERT_TRUE(checkpoint);
    if (length + 1 < whole.size()) {
      EXPECT_EQ(checkpoint->facts.time, 1) << length;
    }
  }
}

TEST_F(TwoCheckpoints, AnotherCaseAndANewerFormatAreRefusedByTheirReason) {
  EXPECT_FALSE(read("other"));
  ASSERT_EQ(refused.size(), 2u);
  EXPECT_NE(refused[0].find("a case with other settings or data"), std::string::npos) << refused[0];
  const fs::path file = folder / "state/1/manifest.json";
  std::string text = read_file(file);
  const std::string ours = fmt::format("\"version\": {}", newest_format);
  text.replace(text.find(ours), ours.size(), fmt::format("\"version\": {}", newest_format + 1));
  std::ofstream(file, std::ios::binary) << text;
  EXPECT_EQ(read()->facts.time, 1);
  EXPECT_NE(refused[0].find("newer gaussdrift"), std::string::npos) << refused[0];
}

/// By somebody who knows the check sum.
void write_manifest(const fs::path& file, nlohmann::ordered_json manifest) {
  manifest.erase("crc32");
  const std::string rest = manifest.dump();
  manifest["crc32"] = crc32_z(0, reinterpret_cast<const Bytef*>(rest.data()), rest.size());
  std::ofstream(file, std::ios::binary) << manifest.dump(2);
}

TEST_F(TwoCheckpoints, ACraftedManifestIsRefusedByItsReason) {
  using json = nlohmann::ordered_json;
  const fs::path file = folder / "state/1/manifest.json";
  const json honest = json::parse(read_file(file));
  const json piece = honest["pieces"][0];
  const std::vector<std::tuple<const char*, json, const char*>> crafted = {
      {"/state/file", "../0/run.raw", "its manifest names a file elsewhere"},
      {"/state/file", std::string("run.raw\0", 8), "its manifest names a file elsewhere"},
      {"/state/file", "", " is missing"},
      {"/particles", -3, "particles is no count"},
      {"/particles", 1e300, "particles is no count"},
      {"/steps", 1.5, "steps is no count"},
      {"/serial", "2", "serial is no count"},
      {"/dimension", 4, "its dimension is wrong"},
      {"/time", nullptr, "time is no number"},
      {"/case", json::array(), "case is no text"},
      {"/columns", json::object(), "columns is no list"},
      {"/pieces", {piece, piece}, "its pieces are wrong"},
      {"/pieces/0/particles", std::uint64_t{1} << 63, "its pieces are wrong"},
      {"/spread", "nan", "spread is no width"},
      {"/outputs/count", 3, "its outputs are wrong"},
      {"/outputs/bytes", std::uint64_t{1} << 60, "bytes, must have"},
      {"/outputs/bytes", 20, "outputs.raw is damaged: its check sum is wrong"},
      {"/outputs", nullptr, "count is no count"},
      {"/version", -1, "version is no count"}};
  for (const auto& [place, value, why] : crafted) {
    json manifest = honest;
    manifest[json::json_pointer(place)] = value;
    write_manifest(file, std::move(manifest));
    EXPECT_EQ(read()->facts.time, 1) << place;
    ASSERT_EQ(refused.size(), 1u) << place;
    EXPECT_NE(refused[0].find(why), std::string::npos) << refused[0];
  }
}

// Its check sum is that of the text as it is written again, which must not take a stack without bound.
TEST_F(TwoCheckpoints, AManifestThatIsNestedDeeplyIsRefused) {
  std::string text = read_file(folder / "state/1/manifest.json");
  const std::string deep(400'000, '['), closed(400'000, ']');
  text.insert(1, "\"more\": " + deep + closed + ",");
  std::ofstream(folder / "state/1/manifest.json", std::ios::binary) << text;
  EXPECT_EQ(read()->facts.time, 1);
  EXPECT_NE(refused[0].find("nested more than 50 deep"), std::string::npos) << refused[0];
}

TEST(Checkpoint, WhereThereIsNoneNothingIsRefused) {
  const ScratchFolder folder;
  std::vector<std::string> refused;
  EXPECT_FALSE(read_checkpoint(folder.path(), "hash", refused, alone));
  EXPECT_TRUE(refused.empty());
}

TEST(Checkpoint, AFullDiskLeavesTheOneBefore) {
  const ScratchFolder folder;
  CheckpointWriter writer = writer_to(folder);
  writer.write("hash", 1, 10, some_particles(5, 0), state_of("first", {"one"}));
  {
    const FileSizeLimit limit(100);
    EXPECT_THROW(writer.write("hash", 2, 20, some_particles(500, 0), state_of("second", {"one"})), FileError);
    EXPECT_THROW(writer.write("hash", 2, 20, some_particles(1, 0), state_of("second", {"one", std::string(200, 'x')})),
                 FileError);
  }
  std::vector<std::string> refused;
  EXPECT_EQ(read_checkpoint(folder.path(), "hash", refused, alone)->facts.time, 1);
  EXPECT_EQ(read_checkpoint(folder.path(), "hash", refused, alone)->state, state_of("first", {"one"}));
}

/// Format 1 had no file of outputs: run.raw had all.
TEST(Checkpoint, OfFormat1IsRead) {
  const ScratchFolder folder;
  writer_to(folder).write("hash", 1, 10, some_particles(5, 0), state_of("all of it"));
  const fs::path file = folder / "state/0/manifest.json";
  nlohmann::ordered_json manifest = nlohmann::ordered_json::parse(read_file(file));
  manifest["version"] = 1;
  manifest.erase("outputs");
  write_manifest(file, std::move(manifest));
  fs::remove(folder / "state/outputs.raw");
  std::vector<std::string> refused;
  const auto checkpoint = read_checkpoint(folder.path(), "hash", refused, alone);
  ASSERT_TRUE(checkpoint);
  const RunState parts = parted(checkpoint->state);
  EXPECT_EQ(parts.format, 1u);
  EXPECT_EQ(parts.run, "all of it");
}

}  // namespace
}  // namespace gaussdrift::write
