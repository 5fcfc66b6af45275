// A .pvti that lies about itself: refused with the place and the reason, before memory is taken for what it claims.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "read/stored_density.hpp"
#include "read/written_run.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::read {
namespace {

namespace fs = std::filesystem;

class HostilePieces : public testing::Test {
 protected:
  HostilePieces() {
    fs::create_directories(folder_ / "run/p");
    piece("run/p/0.vti", 0, 3, 0);
    piece("run/p/1.vti", 3, 5, 1);
    piece("0.vti", 0, 3, 0);  // outside
  }

  /// Points from `begin` to `last` along x, 0 to 2 along y.
  void piece(const std::string& name, int begin, int last, int seed, const std::string& attributes = standing) const {
    std::string numbers;
    for (int i = 0; i < 3 * (last - begin + 1); ++i) numbers += fmt::format("{} ", seed + i);
    std::ofstream(folder_ / name) << fmt::format(
        "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"{0} {1} 0 2 "
        "0 "
        "0\" {2}><Piece Extent=\"{0} {1} 0 2 0 0\"><PointData><DataArray type=\"Float64\" Name=\"rho\" "
        "format=\"ascii\">{3}</DataArray></PointData></Piece></ImageData></VTKFile>\n",
        begin, last, attributes, numbers);
  }

  fs::path index(const std::string& pieces, const std::string& extent = "0 5 0 2 0 0",
                 const std::string& attributes = standing) const {
    std::ofstream(folder_ / "run/d.pvti") << fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PImageData\" version=\"1.0\">\n<PImageData WholeExtent=\"{}\" "
        "GhostLevel=\"0\" {}>\n{}</PImageData>\n</VTKFile>\n",
        extent, attributes, pieces);
    return folder_ / "run/d.pvti";
  }

  static std::string entry(const std::string& extent, const std::string& source) {
    return fmt::format("<Piece Extent=\"{}\" Source=\"{}\"/>\n", extent, source);
  }

  static std::string refused(const fs::path& file) {
    return message_of<FileError>([&] { read_density(file, "rho"); });
  }

  static constexpr const char* standing = "Origin=\"1 0 0\" Spacing=\"0.5 0.5 0.5\"";
  const std::string first = entry("0 3 0 2 0 0", "p/0.vti"), second = entry("3 5 0 2 0 0", "p/1.vti");
  ScratchFolder folder_;
};

TEST_F(HostilePieces, AreReadWhereTheyAreHonest) {
  const DensityGrid density = read_density(index(first + second), "rho");
  EXPECT_EQ(density.lattice.points, (std::array<std::size_t, 3>{6, 3, 1}));
  EXPECT_EQ(density.lattice.spacing, 0.5);
  EXPECT_EQ(density.lattice.origin[0], 1.0);
  EXPECT_EQ(density.rho, (std::vector<double>{0, 1, 2, 1, 2, 3, 4, 5, 6, 4, 5, 6, 8, 9, 10, 7, 8, 9}))
      << "a layer that two pieces have is that of the second";
}

TEST_F(HostilePieces, DoNotLeadElsewhere) {
  for (const std::string& source : {std::string("../0.vti"), std::string("p/../../0.vti"), (folder_ / "0.vti").string(),
                                    std::string("/etc/passwd")})
    EXPECT_NE(
        refused(index(entry("0 3 0 2 0 0", source) + second)).find("d.pvti:4: the piece \"" + source.substr(0, 5)),
        std::string::npos)
        << refused(index(entry("0 3 0 2 0 0", source) + second));
  fs::create_symlink(folder_ / "0.vti", folder_ / "run/p/link.vti");
  EXPECT_NE(refused(index(entry("0 3 0 2 0 0", "p/link.vti") + second)).find("is not in the folder of d.pvti"),
            std::string::npos);
  EXPECT_NE(refused(index(entry("0 3 0 2 0 0", "") + second)).find("d.pvti:4: this <Piece> has no Source"),
            std::string::npos);
  EXPECT_NE(refused(index(entry("0 3 0 2 0 0", "p/0.txt") + second)).find("is not a .vti"), std::string::npos);
  EXPECT_NE(refused(index(entry("0 3 0 2 0 0", "p/2.vti") + second)).find("2.vti, which line 4 of"), std::string::npos);
}

TEST_F(HostilePieces, FillTheGrid) {
  EXPECT_NE(refused(index(first)).find("leave cells of its extent without values"), std::string::npos);
  EXPECT_NE(refused(index("")).find("names no pieces"), std::string::npos);
  EXPECT_NE(refused(index(first + entry("2 5 0 2 0 0", "p/1.vti"))).find("lines 4 and 5 overlap"), std::string::npos);
  EXPECT_NE(refused(index(first + first + second)).find("lines 4 and 5 overlap"), std::string::npos);
  EXPECT_NE(refused(index(first + entry("3 6 0 2 0 0", "p/1.vti"))).find("reaches beyond WholeExtent"),
            std::string::npos);
  EXPECT_NE(refused(index(first + second + entry("3 3 0 2 0 0", "p/0.vti"))).find("a single layer of points along x"),
            std::string::npos);
  EXPECT_NE(refused(index(first + second, "0 5 0 2000 0 0")).find("leave cells"), std::string::npos);
}

TEST_F(HostilePieces, ClaimNoMoreThanThereIs) {
  EXPECT_NE(refused(index(first + second, "0 1000000000 0 1000000000 0 0")).find("at most 1.1e+12 are possible"),
            std::string::npos);
  EXPECT_NE(refused(index(entry("0 1000000 0 1000000 0 0", "p/0.vti"), "0 1000000 0 1000000 0 0"))
                .find("is not the one that line 4"),
            std::string::npos);
  EXPECT_NE(refused(index(first + second, "0 5 0 2 0 4000000000")).find("WholeExtent"), std::string::npos);
  EXPECT_NE(refused(index(first + second, "0 5 0 2 0 x")).find("six whole numbers"), std::string::npos);
}

TEST_F(HostilePieces, AreWhatTheIndexSays) {
  piece("run/p/1.vti", 3, 5, 1, "Origin=\"2 0 0\" Spacing=\"0.5 0.5 0.5\"");
  EXPECT_NE(refused(index(first + second)).find("1.vti is not the one that line 5 of"), std::string::npos);
  piece("run/p/1.vti", 3, 4, 1);
  EXPECT_NE(refused(index(first + second)).find("1.vti is not the one that line 5 of"), std::string::npos);
  EXPECT_NE(refused(index(first + second, "0 5 0 2 0 0", "Spacing=\"0.5 0.25 0.5\"")).find("not the same on all axes"),
            std::string::npos);
  EXPECT_NE(message_of<FileError>([&] { read_density(index(first + second), "error"); }).find("no array \"error\""),
            std::string::npos);
  std::ofstream(folder_ / "run/d.pvti") << "<VTKFile type=\"ImageData\"><PImageData/></VTKFile>";
  EXPECT_NE(refused(folder_ / "run/d.pvti").find("is not a file of the kind that its name says"), std::string::npos);
}

TEST_F(HostilePieces, AreFoundInTheFolderOfARun) {
  fs::create_directories(folder_ / "run/density/density_0007");
  piece("run/density/density_0007/0000.vti", 0, 5, 0);
  fs::rename(index(entry("0 5 0 2 0 0", "density_0007/0000.vti")), folder_ / "run/density/density_0007.pvti");
  piece("run/density/density_0003.vti", 0, 5, 0);
  const auto outputs = written_outputs(folder_ / "run", "density");
  ASSERT_EQ(outputs.size(), 2u);
  EXPECT_EQ(outputs[0].number, 3u);
  EXPECT_EQ(outputs[1].number, 7u);
  EXPECT_EQ(outputs[1].file.filename(), "density_0007.pvti");
}

}  // namespace
}  // namespace gaussdrift::read
