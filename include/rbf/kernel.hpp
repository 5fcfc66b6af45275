/// @file
/// The radial kernels of the library rbf, by name.
#pragma once

namespace rbf {

/// What a centre of weight 1 adds at a distance r; c is the shape, a length. None is normalised.
enum class Kernel {
  gaussian,              ///< exp(-r^2 / c^2)
  multiquadric,          ///< sqrt(r^2 + c^2)
  inverse_multiquadric,  ///< 1 / sqrt(r^2 + c^2)
  inverse_quadratic,     ///< 1 / (r^2 + c^2)
  thin_plate,            ///< r^2 ln r, which takes no shape
  matern32,              ///< (1 + a) exp(-a),  a = sqrt(3) r / c
  matern52               ///< (1 + a + a^2/3) exp(-a),  a = sqrt(5) r / c
};

}  // namespace rbf
