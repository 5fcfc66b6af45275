// Tables 3.2 to 3.5, 4.1 to 4.8, 6.1 and 6.2 of [Sch06] as printed; errors that are printed as a power of ten are that
// power.
#pragma once

#include <array>
#include <limits>

namespace gaussdrift::study::published {

/// A break-even that is never reached, a factor below one: printed as a dash.
constexpr double never = std::numeric_limits<double>::infinity();

// Tables 3.2 to 3.5: rows nu, columns p = 5 .. 12.
constexpr std::array<int, 8> terms{5, 6, 7, 8, 9, 10, 11, 12};
struct RowOfNu {
  int nu;
  std::array<double, 8> value;
};
constexpr std::array<RowOfNu, 4> table_32{{
    {1, {250, 432, 686, 1024, 1458, 2000, 2662, 3456}},
    {2, {1125, 1944, 3087, 4608, 6561, 9000, 11979, 15552}},
    {3, {3500, 6048, 9604, 14336, 20412, 28000, 37268, 48384}},
    {4, {8125, 14040, 22295, 33280, 47385, 65000, 86515, 112320}},
}};
constexpr std::array<RowOfNu, 3> table_33{{
    {2, {1e-2, 1e-2, 1e-3, 1e-4, 1e-5, 1e-5, 1e-6, 1e-7}},
    {3, {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}},
    {4, {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11}},
}};
constexpr std::array<RowOfNu, 4> table_34{{
    {1, {1e-3, 1e-3, 1e-4, 1e-4, 1e-5, 1e-5, 1e-6, 1e-6}},
    {2, {1e-4, 1e-5, 1e-5, 1e-7, 1e-7, 1e-8, 1e-9, 1e-10}},
    {3, {1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12}},
    {4, {1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13}},
}};
constexpr std::array<RowOfNu, 4> table_35{{
    // hundredths of a second
    {1, {0.0006, 0.001, 0.0017, 0.0038, 0.0038, 0.0048, 0.0064, 0.0083}},
    {2, {0.0015, 0.002, 0.0037, 0.0055, 0.0077, 0.0107, 0.0142, 0.0183}},
    {3, {0.0020, 0.003, 0.0051, 0.0074, 0.0107, 0.0148, 0.0197, 0.0256}},
    {4, {0.0027, 0.005, 0.0073, 0.0106, 0.0151, 0.0211, 0.0280, 0.0363}},
}};

// Table 4.1: for (p, nu) = (8, 2) and (9, 3) the bound, the absolute and the relative error.
struct Row41 {
  int points;
  std::array<std::array<double, 3>, 2> error;
};
constexpr std::array<Row41, 17> table_41{{
    {200, {{{1e2, 1e-3, 1e-3}, {1e0, 1e-6, 1e-6}}}},
    {400, {{{1e3, 1e-3, 1e-4}, {1e0, 1e-6, 1e-7}}}},
    {600, {{{1e3, 1e-3, 1e-4}, {1e0, 1e-6, 1e-7}}}},
    {800, {{{1e3, 1e-3, 1e-3}, {1e0, 1e-6, 1e-5}}}},
    {1000, {{{1e3, 1e-3, 1e-1}, {1e1, 1e-6, 1e-5}}}},
    {2000, {{{1e3, 1e-3, 1e-3}, {1e1, 1e-6, 1e-6}}}},
    {4000, {{{1e4, 1e-2, 1e-2}, {1e1, 1e-6, 1e-6}}}},
    {6000, {{{1e4, 1e-2, 1e-3}, {1e1, 1e-6, 1e-6}}}},
    {8000, {{{1e4, 1e-2, 1e-3}, {1e1, 1e-5, 1e-6}}}},
    {10000, {{{1e4, 1e-2, 1e-2}, {1e2, 1e-5, 1e-6}}}},
    {12000, {{{1e4, 1e-2, 1e-1}, {1e2, 1e-5, 1e-5}}}},
    {14000, {{{1e4, 1e-2, 1e-2}, {1e2, 1e-5, 1e-6}}}},
    {16000, {{{1e4, 1e-2, 1e-2}, {1e2, 1e-5, 1e-6}}}},
    {18000, {{{1e4, 1e-2, 1e-2}, {1e2, 1e-5, 1e-6}}}},
    {20000, {{{1e5, 1e-2, 1e-2}, {1e2, 1e-5, 1e-5}}}},
    {50000, {{{1e5, 1e-1, 1e-1}, {1e2, 1e-5, 1e-5}}}},
    {100000, {{{1e5, 1e-1, 1e-1}, {1e2, 1e-4, 1e-5}}}},
}};

// Table 4.2: seconds of the direct sum; for (p, nu) = (8, 2) and (9, 3) seconds, and how many times faster.
struct Row42 {
  int points;
  double direct;
  std::array<double, 2> seconds, factor;
};
constexpr std::array<Row42, 17> table_42{{
    {200, 0.0071, {0.0096, 0.0418}, {never, never}},
    {400, 0.0286, {0.0191, 0.0836}, {1, never}},
    {600, 0.0656, {0.0285, 0.1281}, {2, never}},
    {800, 0.1156, {0.0386, 0.1652}, {3, never}},
    {1000, 0.1819, {0.0491, 0.2072}, {4, never}},
    {2000, 0.7244, {0.0950, 0.4184}, {8, 2}},
    {4000, 2.9034, {0.1887, 0.8354}, {15, 3}},
    {6000, 6.5094, {0.2806, 1.2385}, {23, 5}},
    {8000, 11.6354, {0.3803, 1.6720}, {31, 7}},
    {10000, 18.2025, {0.4750, 2.0931}, {38, 9}},
    {12000, 26.2199, {0.5718, 2.5157}, {46, 10}},
    {14000, 35.7310, {0.6686, 2.9187}, {53, 12}},
    {16000, 46.4547, {0.7563, 3.3012}, {61, 14}},
    {18000, 59.0739, {0.8590, 3.7755}, {69, 16}},
    {20000, 73.0214, {0.9537, 4.1664}, {77, 18}},
    {50000, 456.9920, {2.3792, 10.4886}, {192, 44}},
    {100000, 1828.1900, {4.7563, 20.9087}, {384, 87}},
}};

// Table 4.3: seconds to prepare, and to evaluate one target, for (p, nu) = (8, 2) and (9, 3).
struct Row43 {
  int sources;
  std::array<double, 2> prepare, evaluate;
};
constexpr std::array<Row43, 16> table_43{{
    {2000, {0.0119, 0.0171}, {0.0001, 0.0003}},
    {4000, {0.0238, 0.0344}, {0.0001, 0.0003}},
    {6000, {0.0393, 0.0513}, {0.0001, 0.0003}},
    {8000, {0.0478, 0.0685}, {0.0001, 0.0003}},
    {10000, {0.0593, 0.0857}, {0.0001, 0.0003}},
    {12000, {0.0712, 0.1026}, {0.0001, 0.0003}},
    {14000, {0.0864, 0.1231}, {0.0001, 0.0003}},
    {16000, {0.0950, 0.1368}, {0.0001, 0.0003}},
    {18000, {0.1068, 0.1537}, {0.0001, 0.0003}},
    {20000, {0.1185, 0.1729}, {0.0001, 0.0003}},
    {50000, {0.2967, 0.4249}, {0.0001, 0.0003}},
    {100000, {0.6313, 0.8636}, {0.0001, 0.0003}},
    {500000, {3.1855, 4.2668}, {0.0001, 0.0003}},
    {1000000, {5.8441, 8.4137}, {0.0001, 0.0003}},
    {5000000, {29.3359, 42.4881}, {0.0001, 0.0003}},
    {10000000, {58.7618, 84.2599}, {0.0001, 0.0003}},
}};

// Table 4.4: break-even, measured and from the cost, for p = 8 and nu = 2, 3, 4, then p = 9 and nu = 2, 3, 4.
struct Row44 {
  int sources;
  std::array<double, 6> numerical, analytical;
};
constexpr std::array<Row44, 12> table_44{{
    {2000, {44, 52, 222, 62, 125, never}, {never, never, never, never, never, never}},
    {4000, {39, 46, 76, 61, 82, 226}, {never, never, never, never, never, never}},
    {6000, {37, 41, 51, 59, 66, 95}, {1614, never, never, 26036, never, never}},
    {8000, {36, 39, 45, 53, 65, 83}, {1050, never, never, 2691, never, never}},
    {10000, {35, 38, 42, 54, 58, 69}, {868, never, never, 1750, never, never}},
    {12000, {35, 37, 40, 52, 54, 64}, {778, never, never, 1419, never, never}},
    {14000, {37, 32, 33, 115, 46, 133}, {724, 40728, never, 1250, never, never}},
    {16000, {34, 36, 41, 51, 52, 60}, {689, 3765, never, 1148, never, never}},
    {18000, {34, 35, 38, 51, 52, 59}, {663, 2207, never, 1079, never, never}},
    {20000, {34, 35, 37, 50, 51, 58}, {644, 1659, never, 1030, 45994, never}},
    {50000, {30, 31, 31, 44, 44, 46}, {558, 708, 1486, 826, 1203, 10901}},
    {100000, {30, 31, 31, 44, 44, 45}, {534, 595, 762, 775, 908, 1367}},
}};

// Table 4.5: seconds, and cost in millions.
struct Row45 {
  int dimension;
  double direct_seconds, direct_cost, seconds, cost;
};
constexpr std::array<Row45, 3> table_45{{
    {2, 448.261, 2500, 0.3936, 41},
    {3, 464.511, 2500, 10.4172, 1021},
    {4, 491.189, 2500, 332.1150, 26900},
}};

// Table 4.6: absolute error for n = 0, 1, and 2 or more.
struct Row46 {
  double sigma;
  std::array<double, 3> error;
};
constexpr std::array<Row46, 9> table_46{{
    {10000, {1e28, 1e28, 1e28}},
    {1000, {1e15, 1e15, 1e15}},
    {100, {1e4, 1e3, 1e3}},
    {10, {1e3, 1e3, 1e-2}},
    {1, {1e3, 1e3, 1e-8}},
    {0.1, {1e2, 1e2, 1e-12}},
    {0.01, {1e0, 1e0, 1e-14}},
    {0.001, {1e-2, 1e-2, 1e-16}},
    {0.0001, {1e-4, 1e-4, 1e-18}},
}};

// Table 4.7: for n_g = 100, 200, 300 the boxes an axis and the absolute error.
constexpr std::array<int, 3> lattices{100, 200, 300};
struct Row47 {
  int overlap;
  std::array<double, 3> sigma;
  std::array<int, 3> nu;
  std::array<double, 3> error;
};
constexpr std::array<Row47, 11> table_47{{
    {1, {9801.00, 39601.00, 89401.00}, {280, 562, 845}, {1e-13, 1e-13, 1e-14}},
    {2, {2450.25, 9900.25, 22350.20}, {140, 281, 422}, {1e-12, 1e-13, 1e-13}},
    {4, {612.56, 2475.06, 5587.56}, {70, 140, 211}, {1e-12, 1e-13, 1e-13}},
    {6, {272.25, 1100.03, 2483.36}, {46, 93, 140}, {1e-12, 1e-12, 1e-13}},
    {8, {153.14, 618.77, 1396.89}, {35, 70, 105}, {1e-12, 1e-12, 1e-12}},
    {10, {98.01, 396.01, 894.01}, {28, 56, 84}, {1e-12, 1e-12, 1e-12}},
    {12, {68.06, 275.01, 620.84}, {23, 46, 70}, {1e-12, 1e-12, 1e-12}},
    {14, {50.01, 202.05, 456.13}, {20, 40, 60}, {1e-12, 1e-12, 1e-13}},
    {16, {38.29, 154.69, 349.22}, {17, 35, 52}, {1e-11, 1e-12, 1e-12}},
    {18, {30.25, 122.23, 275.93}, {15, 31, 46}, {1e-11, 1e-12, 1e-12}},
    {20, {24.50, 99.00, 223.50}, {14, 28, 42}, {1e-11, 1e-12, 1e-12}},
}};

// Table 4.8: relative error for the columns (sigma, nu, n); n = -1 is as many as give every box.
struct Column48 {
  double sigma;
  int nu;
  int neighbours;
};
constexpr std::array<Column48, 6> columns_48{
    {{0.01, 1, 0}, {1, 3, 0}, {1, 3, -1}, {100, 29, 0}, {100, 29, 3}, {100, 29, -1}}};
struct Row48 {
  const char* data;
  std::array<double, 6> error;
};
constexpr std::array<Row48, 4> table_48{{
    {"halton", {4.60e-14, 0.955033, 1.44e-11, 0.965226, 0.313796, 1.12e-9}},
    {"random", {4.76e-14, 0.961725, 1.28e-11, 0.973899, 0.406368, 4.60e-10}},
    {"grid", {4.90e-14, 0.964972, 3.07e-10, 0.963447, 0.383820, 2.55e-9}},
    {"clustered", {4.77e-14, 0.999698, 2.22e-10, 0.998000, 0.870093, 9.07e-10}},
}};

// Table 6.1: seconds of brute force and of the fast transform, absolute and relative error, factor between the times.
struct Row61 {
  int points;
  double direct, seconds, absolute, relative, factor;
};
constexpr std::array<Row61, 10> table_61{{
    {2000, 9.1538, 4.7965, 1e-6, 1e-5, 2},
    {4000, 35.3481, 9.6214, 1e-5, 1e-5, 4},
    {6000, 79.4670, 14.3705, 1e-5, 1e-5, 6},
    {8000, 141.3670, 19.1860, 1e-5, 1e-5, 7},
    {10000, 220.9470, 24.0604, 1e-5, 1e-5, 9},
    {12000, 318.4240, 28.8216, 1e-5, 1e-4, 11},
    {14000, 435.0740, 33.4961, 1e-5, 1e-4, 13},
    {16000, 566.4560, 38.3738, 1e-5, 1e-4, 15},
    {18000, 717.7070, 43.1628, 1e-5, 1e-5, 17},
    {20000, 886.1680, 47.9660, 1e-5, 1e-5, 18},
}};

// Table 6.2: seconds and result of brute force and of the fast transform.
struct Row62 {
  int sources;
  double direct_seconds, direct, seconds, divergence;
};
constexpr std::array<Row62, 2> table_62{{
    {10000, 0.0216, 1e-13, 0.2596, 0},
    {100000, 0.2165, 1e-12, 2.5619, 0},
}};

}  // namespace gaussdrift::study::published
