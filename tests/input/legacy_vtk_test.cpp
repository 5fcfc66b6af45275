// Legacy .vtk, and .vti in pieces.
#include <algorithm>
#include <cstring>

#include "grid_files.hpp"

namespace gaussdrift::input {
namespace {

using Numbers = std::vector<double>;

class LegacyVtk : public GridFile {
 protected:
  void write(const std::string& text) const { std::ofstream(folder_ / "a.vtk", std::ios::binary) << text; }
  std::string refused(const std::string& text) const {
    write(text);
    return refusal("a.vtk", {.most_components = 3});
  }
  /// As a binary file has them: the most significant byte comes first.
  template <class T>
  static std::string binary(const std::vector<T>& numbers) {
    std::string all;
    for (const T number : numbers) {
      char bytes[sizeof(T)];
      std::memcpy(bytes, &number, sizeof(T));
      std::reverse(bytes, bytes + sizeof(T));
      all.append(bytes, sizeof(T));
    }
    return all;
  }
  static inline const std::string image =
      "# vtk DataFile Version 3.0\nwind\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 3 1\nORIGIN 1 2 0\nSPACING 0.5 "
      "1 "
      "1\n";
};

TEST_F(LegacyVtk, holds_image_data_as_text) {
  write(image +
        "POINT_DATA 6\nVECTORS wind float\n1 2 0 3 4 0 5 6 0\n7 8 0 9 10 0 11 12 0\nSCALARS rho double 1\n"
        "LOOKUP_TABLE default\n1 2 3 4 5 6\n");
  const auto data = read::read_grid(folder_ / "a.vtk", vector_of("wind"));
  EXPECT_EQ(data->axis[0], (Numbers{1, 1.5}));
  EXPECT_EQ(data->axis[1], (Numbers{2, 3, 4}));
  EXPECT_EQ((Numbers{data->values[0][9], data->values[0][10]}), (Numbers{7, 8}));
  EXPECT_EQ(read::read_grid(folder_ / "a.vtk", {.arrays = {"rho"}})->values[0], (Numbers{1, 2, 3, 4, 5, 6}));
}

TEST_F(LegacyVtk, holds_rectilinear_grids_in_binary) {
  write("# vtk DataFile Version 4.2\nt\nBINARY\nDATASET RECTILINEAR_GRID\nDIMENSIONS 3 2 1\nX_COORDINATES 3 float\n" +
        binary<float>({0, 1, 4}) + "\nY_COORDINATES 2 double\n" + binary<double>({5, 3}) + "\nZ_COORDINATES 1 int\n" +
        binary<std::int32_t>({0}) + "\nPOINT_DATA 6\nFIELD FieldData 2\nu 1 6 double\n" +
        binary<double>({1, 2, 3, 4, 5, 6}) + "\nMETADATA\nINFORMATION 0\n\nv 1 6 short\n" +
        binary<std::int16_t>({-1, -2, -3, -4, -5, -6}) + "\n");
  const auto data =
      read::read_grid(folder_ / "a.vtk", {.arrays = {"u", "v"}, .least_components = 2, .most_components = 2});
  EXPECT_EQ(data->axis[0], (Numbers{0, 1, 4}));
  EXPECT_EQ(data->axis[1], (Numbers{3, 5}));
  EXPECT_EQ(data->values[0], (Numbers{4, -4, 5, -5, 6, -6, 1, -1, 2, -2, 3, -3}));
}

TEST_F(LegacyVtk, values_of_cells_stand_at_their_middles) {
  write(
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 3 1\nORIGIN 0 0 0\nSPACING 1 1 1\n"
      "CELL_DATA 4\nSCALARS rho int\nLOOKUP_TABLE default\n1 2 3 4\n");
  EXPECT_EQ(read::read_grid(folder_ / "a.vtk", {})->axis[0], (Numbers{0, 0.5, 1.5, 2}));
}

TEST_F(LegacyVtk, that_is_damaged_is_refused_with_its_line) {
  EXPECT_NE(refused("").find("a.vtk:1: this is no legacy file of VTK"), std::string::npos);
  EXPECT_NE(refused(image + "POINT_DATA 7\n").find("a.vtk:8: POINT_DATA does not have as many entries"),
            std::string::npos);
  EXPECT_NE(refused(image + "POINT_DATA 6\nSCALARS rho float\nLOOKUP_TABLE default\n1 2 3 4 5").find("the file ends"),
            std::string::npos);
  EXPECT_NE(refused(image + "POINT_DATA 6\nSCALARS rho float\nLOOKUP_TABLE default\n1 2 3 4 5 6,5")
                .find("\"6,5\" is no number"),
            std::string::npos);
  EXPECT_NE(refused(image + "POINT_DATA 6\nSCALARS rho complex\n").find("\"complex\" is no type"), std::string::npos);
  EXPECT_NE(refused("# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n")
                .find("of the kind UNSTRUCTURED_GRID"),
            std::string::npos);
  EXPECT_NE(
      refused("# vtk DataFile Version 3.0\nt\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 10000 10000 2\nPOINT_DATA "
              "200000000\nSCALARS rho double\nLOOKUP_TABLE default\nabc")
          .find("the file ends within its numbers"),
      std::string::npos);
  EXPECT_NE(refused("# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 100000 100000 2\n")
                .find("the grid has 2e+10 points"),
            std::string::npos);
}

class Pvti : public GridFile {
 protected:
  void write_index(const std::string& pieces) const {
    std::ofstream(folder_ / "a.pvti")
        << "<VTKFile type=\"PImageData\"><PImageData WholeExtent=\"0 4 0 2 0 0\" Origin=\"1 0 "
           "0\" Spacing=\"0.5 0.5 0.5\">"
        << pieces << "</PImageData></VTKFile>\n";
  }
  void write_piece(const std::string& name, int from, int to, const std::string& values) const {
    const std::string extent = fmt::format("{} {} 0 2 0 0", from, to);
    write_pieces(name, extent, "Origin=\"1 0 0\" Spacing=\"0.5 0.5 0.5\"",
                 fmt::format("<Piece Extent=\"{}\">{}</Piece>", extent, data(array("rho", 1, values))));
  }
  static inline const std::string both =
      "<Piece Extent=\"0 2 0 2 0 0\" Source=\"a0.vti\"/><Piece Extent=\"2 4 0 2 0 0\" Source=\"a1.vti\"/>";
};

TEST_F(Pvti, is_put_together_from_its_pieces) {
  write_index(both);
  write_piece("a0.vti", 0, 2, "0 1 2 10 11 12 20 21 22");
  write_piece("a1.vti", 2, 4, "2 3 4 12 13 14 22 23 24");
  const auto grid = read::read_grid(folder_ / "a.pvti", {});
  EXPECT_EQ(grid->axis[0], (Numbers{1, 1.5, 2, 2.5, 3}));
  EXPECT_EQ(grid->values[0], (Numbers{0, 1, 2, 3, 4, 10, 11, 12, 13, 14, 20, 21, 22, 23, 24}));
}

TEST_F(Pvti, is_refused_where_a_piece_is_missing_or_another) {
  write_index(both);
  write_piece("a0.vti", 0, 2, "0 1 2 10 11 12 20 21 22");
  EXPECT_NE(refusal("a.pvti", {}).find("a1.vti"), std::string::npos);
  write_piece("a1.vti", 2, 3, "2 3 12 13 22 23");
  EXPECT_NE(refusal("a.pvti", {}).find("a1.vti has 2 points along x"), std::string::npos);
  write_piece("a1.vti", 3, 5, "2 3 4 12 13 14 22 23 24");
  EXPECT_NE(refusal("a.pvti", {}).find("a1.vti lies elsewhere"), std::string::npos);
}

}  // namespace
}  // namespace gaussdrift::input
