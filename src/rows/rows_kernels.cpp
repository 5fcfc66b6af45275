// The kernels of rows.hpp; see core/simd/pack.hpp for what may stand here.
#include "rows/kernels.hpp"
#include "rows/pack_functions.hpp"

namespace gaussdrift::rows::CORE_ISA {

namespace {

/// As broadcast(), but a zero keeps its sign.
CORE_INLINE Pack repeated(double x) {
  Pack all;
  for (std::size_t i = 0; i < lanes; ++i) all[i] = x;
  return all;
}

/// The first `count` < lanes numbers; the last one fills what is left, so that no lane has anything else.
CORE_INLINE Pack load_some(const double* from, std::size_t count) {
  Pack x = repeated(from[count - 1]);
  for (std::size_t i = 0; i + 1 < count; ++i) x[i] = from[i];
  return x;
}

CORE_INLINE void store_some(double* to, std::size_t count, Pack x) {
  for (std::size_t i = 0; i < count; ++i) to[i] = x[i];
}

template <Pack (*f)(Pack)>
void one(double* a, std::size_t count) {
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) store(a + i, f(load(a + i)));
  if (i < count) store_some(a + i, count - i, f(load_some(a + i, count - i)));
}

template <Pack (*f)(Pack, Pack)>
void two(double* a, const double* b, bool b_same, std::size_t count) {
  std::size_t i = 0;
  if (b_same) {
    const Pack all = repeated(*b);
    for (; i + lanes <= count; i += lanes) store(a + i, f(load(a + i), all));
    if (i < count) store_some(a + i, count - i, f(load_some(a + i, count - i), all));
    return;
  }
  for (; i + lanes <= count; i += lanes) store(a + i, f(load(a + i), load(b + i)));
  if (i < count) store_some(a + i, count - i, f(load_some(a + i, count - i), load_some(b + i, count - i)));
}

CORE_INLINE Pack one_where(Signed mask) { return select(reinterpret_cast<Bits>(mask), broadcast(1.0)); }

CORE_INLINE Pack negate(Pack x) { return -x; }
CORE_INLINE Pack square(Pack x) { return x * x; }
CORE_INLINE Pack cube(Pack x) { return x * x * x; }
CORE_INLINE Pack fourth(Pack x) { return (x * x) * (x * x); }
CORE_INLINE Pack absolute(Pack x) { return reinterpret_cast<Pack>(reinterpret_cast<Bits>(x) & ~(1ULL << 63)); }
CORE_INLINE Pack add(Pack x, Pack y) { return x + y; }
CORE_INLINE Pack subtract(Pack x, Pack y) { return x - y; }
CORE_INLINE Pack multiply(Pack x, Pack y) { return x * y; }
CORE_INLINE Pack divide(Pack x, Pack y) { return x / y; }
CORE_INLINE Pack less(Pack x, Pack y) { return one_where(x < y); }
CORE_INLINE Pack greater(Pack x, Pack y) { return one_where(x > y); }
CORE_INLINE Pack less_equal(Pack x, Pack y) { return one_where(x <= y); }
CORE_INLINE Pack greater_equal(Pack x, Pack y) { return one_where(x >= y); }
CORE_INLINE Pack equal(Pack x, Pack y) { return one_where(x == y); }
CORE_INLINE Pack not_equal(Pack x, Pack y) { return one_where(x != y); }
CORE_INLINE Pack both(Pack x, Pack y) { return one_where((x != 0.0) & (y != 0.0)); }
CORE_INLINE Pack either(Pack x, Pack y) { return one_where((x != 0.0) | (y != 0.0)); }

void combine(double* out, const double* base, const double* const* terms, const double* factors, std::size_t term_count,
             std::size_t count) {
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    Pack sum = load(base + i);
    for (std::size_t k = 0; k < term_count; ++k) sum += factors[k] * load(terms[k] + i);
    store(out + i, sum);
  }
  for (; i < count; ++i) {
    double sum = base[i];
    for (std::size_t k = 0; k < term_count; ++k) sum += factors[k] * terms[k][i];
    out[i] = sum;
  }
}

}  // namespace

extern const Kernels row_kernels;
const Kernels row_kernels = {
    .negate = one<negate>,
    .square = one<square>,
    .cube = one<cube>,
    .fourth = one<fourth>,
    .abs = one<absolute>,
    .sqrt = one<root>,
    .sin = one<sin>,
    .cos = one<cos>,
    .tan = one<tan>,
    .asin = one<asin>,
    .acos = one<acos>,
    .atan = one<atan>,
    .tanh = one<tanh>,
    .atanh = one<atanh>,
    .exp = one<exp>,
    .log = one<log>,
    .log2 = one<log2>,
    .log10 = one<log10>,
    .cbrt = one<cbrt>,
    .erf = one<erf>,
    .add = two<add>,
    .subtract = two<subtract>,
    .multiply = two<multiply>,
    .divide = two<divide>,
    .pow = two<pow>,
    .atan2 = two<atan2>,
    .hypot = two<hypot>,
    .less = two<less>,
    .greater = two<greater>,
    .less_equal = two<less_equal>,
    .greater_equal = two<greater_equal>,
    .equal = two<equal>,
    .not_equal = two<not_equal>,
    .both = two<both>,
    .either = two<either>,
    .combine = combine,
};

}  // namespace gaussdrift::rows::CORE_ISA
