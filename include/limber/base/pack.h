// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_pack_h
#define limber_base_pack_h

#include <limber/base/expected.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

/**
 * @file A pack is a few doubles that the compiler keeps in one vector
 * register (or several, on machines with short ones). Arithmetic, comparison
 * and the selection <tt>mask ? a : b</tt> are the compiler's own; this file
 * adds what it lacks. Laws are written for a type @p Number that is a pack in
 * the sweeps and a double in the tests, so every function here has both forms.
 */
namespace limber
{
  namespace internal
  {
    template <int width>
    struct PackType
    {
      typedef double type __attribute__((vector_size(width * sizeof(double))));
      typedef std::int64_t mask
        __attribute__((vector_size(width * sizeof(double))));
    };

    template <>
    struct PackType<1>
    {
      using type = double;
      using mask = bool;
    };
  } // namespace internal

  template <int width>
  using Pack = typename internal::PackType<width>::type;

  /** Of eight doubles at most. */
#ifdef __AVX512F__
  inline constexpr int widest_pack = 8;
  inline constexpr int n_registers = 32;
#else
  inline constexpr int widest_pack = 4;
  inline constexpr int n_registers = 16;
#endif

  /** How many doubles a Number holds. */
  template <class Number>
  inline constexpr int pack_width = sizeof(Number) / sizeof(double);

  namespace internal
  {
    /** Integers that hold the bits of a Number. */
    template <class Number>
    using Bits =
      std::conditional_t<pack_width<Number> == 1,
                         std::int64_t,
                         typename PackType<pack_width<Number>>::mask>;

    /** The same bits as another type of the same size. */
    template <class To, class From>
    inline To
    same_bits(const From &from)
    {
      static_assert(sizeof(To) == sizeof(From));
      To to;
      std::memcpy(&to, &from, sizeof(to));
      return to;
    }

    /** Integers as the exponents of doubles, biased; of numbers that are none
     * any bits, so scalars are shifted without a sign. */
    template <class Bits>
    inline Bits
    as_exponent(const Bits &n)
    {
      if constexpr (std::is_integral_v<Bits>)
        return static_cast<Bits>(static_cast<std::uint64_t>(n) << 52);
      else
        return n << 52;
    }
  } // namespace internal



  template <class Number>
  inline Number
  load(const double *const from)
  {
    Number to;
    std::memcpy(&to, from, sizeof(Number));
    return to;
  }



  template <class Number>
  inline void
  store(const Number &from, double *const to)
  {
    std::memcpy(to, &from, sizeof(Number));
  }



  /**
   * Eight doubles as two packs: where these fill the registers of the machine,
   * as GCC keeps vectors of its own of such a length in memory, whatever is
   * done with them, and where half of the work is for the lower lanes alone. A
   * double counts as a pack with equal lanes.
   */
  struct SplitPack
  {
    using Half = Pack<4>;

    SplitPack() = default;

    __attribute__((always_inline))
    SplitPack(const Half &lower, const Half &upper)
      : lower(lower)
      , upper(upper)
    {}

    // Half by half: a copy of the whole waits until both have left for the
    // cache.
    __attribute__((always_inline)) SplitPack(const SplitPack &other)
      : lower(other.lower)
      , upper(other.upper)
    {}

    __attribute__((always_inline)) SplitPack &
    operator=(const SplitPack &other)
    {
      lower = other.lower;
      upper = other.upper;
      return *this;
    }

    __attribute__((always_inline)) SplitPack &
    operator+=(const SplitPack &other)
    {
      lower += other.lower;
      upper += other.upper;
      return *this;
    }

    /** Add to the lower lanes. */
    __attribute__((always_inline)) SplitPack &
    operator+=(const Half &other)
    {
      lower += other;
      return *this;
    }

    __attribute__((always_inline)) SplitPack &
    operator-=(const SplitPack &other)
    {
      lower -= other.lower;
      upper -= other.upper;
      return *this;
    }

    __attribute__((always_inline)) SplitPack &
    operator*=(const double factor)
    {
      lower *= factor;
      upper *= factor;
      return *this;
    }

    __attribute__((always_inline)) friend SplitPack
    operator+(SplitPack a, const SplitPack &b)
    {
      return a += b;
    }

    __attribute__((always_inline)) friend SplitPack
    operator-(SplitPack a, const SplitPack &b)
    {
      return a -= b;
    }

    __attribute__((always_inline)) friend SplitPack
    operator*(const double factor, SplitPack a)
    {
      return a *= factor;
    }

    __attribute__((always_inline)) friend SplitPack
    operator*(SplitPack a, const double factor)
    {
      return a *= factor;
    }

    double
    operator[](const int i) const
    {
      return i < 4 ? lower[i] : upper[i - 4];
    }

    double &
    operator[](const int i)
    {
      return reinterpret_cast<double *>(this)[i];
    }

    Half lower, upper;
  };

  template <>
  __attribute__((always_inline)) inline SplitPack
  load<SplitPack>(const double *const from)
  {
    return {load<SplitPack::Half>(from), load<SplitPack::Half>(from + 4)};
  }

  template <>
  __attribute__((always_inline)) inline void
  store<SplitPack>(const SplitPack &from, double *const to)
  {
    store(from.lower, to);
    store(from.upper, to + 4);
  }



  /**
   * Have the compiler forget what it stored in @p values. To spread one of them
   * over the lanes of a pack is then part of a load, where GCC would permute
   * the register that it stored them from. In three dimensions only: packs of
   * two dimensions are short, and GCC loads several at once, which waits until
   * all of them have left for the cache.
   */
  template <int dim, class Values>
  inline void
  read_from_memory(Values &values)
  {
    if constexpr (dim == 3)
      __asm__("" : "+m"(values));
  }



  /** A pack of eight from one of its lower lanes and one of its upper ones. */
  inline Pack<8>
  joined(const Pack<4> &lower, const Pack<4> &upper)
  {
#ifdef __AVX512F__
    // A copy would wait until both halves have left for the cache.
    return __builtin_shufflevector(lower, upper, 0, 1, 2, 3, 4, 5, 6, 7);
#else
    Pack<8> result;
    std::memcpy(&result, &lower, sizeof(lower));
    std::memcpy(reinterpret_cast<char *>(&result) + sizeof(lower),
                &upper,
                sizeof(upper));
    return result;
#endif
  }



  /** A pack twice as wide, with the same lanes in both of its halves. */
  inline Pack<8>
  doubled(const Pack<4> &half)
  {
    return joined(half, half);
  }

  inline Pack<4>
  doubled(const Pack<2> &half)
  {
    return __builtin_shufflevector(half, half, 0, 1, 0, 1);
  }



  /** Four lanes of a pack from @p first on, 0 or 4. */
  template <class Number>
  __attribute__((always_inline)) inline Pack<4>
  four_lanes(const Number &pack, const int first)
  {
    if constexpr (pack_width<Number> == 4)
      return pack;
    else
      return first == 0 ? __builtin_shufflevector(pack, pack, 0, 1, 2, 3) :
                          __builtin_shufflevector(pack, pack, 4, 5, 6, 7);
  }



  /** The lanes of a wide pack from @p first on that fill a narrow one. */
  template <class Narrow, class Wide>
  inline Narrow
  some_lanes(const Wide &pack, const int first)
  {
    Narrow to;
    std::memcpy(&to,
                reinterpret_cast<const char *>(&pack) + first * sizeof(double),
                sizeof(to));
    return to;
  }



  /** All lanes equal to one value. */
  template <class Number>
  inline Number
  broadcast(const double value)
  {
    return value - Number{};
  }



  template <class Number>
  inline double
  lane(const Number &pack, const int i)
  {
    if constexpr (pack_width<Number> == 1)
      return pack;
    else
      return pack[i];
  }



  template <class Number>
  inline double
  sum(const Number &pack)
  {
    double result = lane(pack, 0);
    for (int i = 1; i < pack_width<Number>; ++i)
      result += lane(pack, i);
    return result;
  }



  template <class Number>
  inline double
  maximum(const Number &pack)
  {
    double result = lane(pack, 0);
    for (int i = 1; i < pack_width<Number>; ++i)
      result = lane(pack, i) > result ? lane(pack, i) : result;
    return result;
  }



  template <class Number>
  inline double
  minimum(const Number &pack)
  {
    double result = lane(pack, 0);
    for (int i = 1; i < pack_width<Number>; ++i)
      result = lane(pack, i) < result ? lane(pack, i) : result;
    return result;
  }



  /** In place of `= {}`, for which GCC calls upon a slow instruction. */
  template <class Number, std::size_t n>
  __attribute__((always_inline)) inline void
  set_zero(std::array<Number, n> &values)
  {
#pragma GCC unroll 27
    for (Number &value : values)
      if constexpr (std::is_class_v<Number> &&
                    !std::is_same_v<Number, SplitPack>)
        set_zero(value);
      else
        value = Number{};
  }



  /** The larger of two, lane by lane. */
  template <class Number>
  inline Number
  larger(const Number &a, const Number &b)
  {
    return a > b ? a : b;
  }

  /** The smaller of two, lane by lane. */
  template <class Number>
  inline Number
  smaller(const Number &a, const Number &b)
  {
    return a < b ? a : b;
  }



  /** The larger of @p a and zero, for which GCC compares and selects unless it
   * knows no zero. */
  template <class Number>
  __attribute__((always_inline)) inline Number
  positive_part(const Number &a)
  {
    Number zero{};
#ifdef __AVX__
    if constexpr (pack_width<Number> <= widest_pack) // in one register
      __asm__("" : "+x"(zero));
#endif
    return larger(a, zero);
  }



  template <class Number>
  inline Number
  magnitude(const Number &a)
  {
    return internal::same_bits<Number>(
      internal::same_bits<internal::Bits<Number>>(a) & 0x7fffffffffffffffLL);
  }



  /** A scalar function applied to each lane. */
  template <class Number, class Function>
  inline Number
  each_lane(const Number &a, const Function &function)
  {
    if constexpr (pack_width<Number> == 1)
      return function(a);
    else
      {
        Number result = a;
        for (int i = 0; i < pack_width<Number>; ++i)
          result[i] = function(a[i]);
        return result;
      }
  }



  template <class Number>
  inline Number
  square_root(const Number &a)
  {
    return each_lane(a, [](const double x) { return std::sqrt(x); });
  }



  /** Values that are not negative, without what is behind the point. */
  template <class Number>
  inline auto
  to_integers(const Number &a)
  {
    if constexpr (pack_width<Number> == 1)
      return static_cast<std::int64_t>(a);
    else
      return __builtin_convertvector(
        a, typename internal::PackType<pack_width<Number>>::mask);
  }

  template <class Number>
  inline Number
  rounded_down(const Number &a)
  {
    if constexpr (pack_width<Number> == 1)
      return static_cast<double>(to_integers(a));
    else
      return __builtin_convertvector(to_integers(a), Number);
  }



  /**
   * 1 / a^(1/3) for positive a, to round-off. The start divides the binary
   * exponent by minus three (within 4 %); two steps then multiply by the series
   * of (1 - e)^(-1/3), e = 1 - a x^3, which is a shorter chain of dependent
   * operations than steps of Newton. Not defined for a <= 0.
   */
  template <class Number>
  inline Number
  inverse_cube_root(const Number &a)
  {
    using Bits = internal::Bits<Number>;
    // 2^20 / 3 times, as packs of integers cannot be divided
    Number x = internal::same_bits<Number>(
      0x553ef0ff289dd796LL - (internal::same_bits<Bits>(a) >> 20) * 349525);
    Number e = 1. - a * (x * (x * x));
    x *=
      1. +
      e * (1. / 3 +
           e * (2. / 9 + e * (14. / 81 + e * (35. / 243 + e * (91. / 729)))));
    e = 1. - a * (x * (x * x));
    return x + x * (e * (1. / 3 + e * (2. / 9)));
  }



  /**
   * The natural logarithm of finite, normal a, to two units in the last place,
   * next to a = 1 as well; not a number where a is not positive. With a = 2^k m
   * and m within a factor sqrt(2) of one, k ln 2 + 2 artanh s, s = (m - 1) / (m
   * + 1), by the series up to s^21. To call the library for each lane took as
   * long as all else that a liquid does.
   */
  template <class Number>
  inline Number
  logarithm(const Number &a)
  {
    using Bits                = internal::Bits<Number>;
    const Bits          bits  = internal::same_bits<Bits>(a);
    constexpr long long start = 0x3fe6a09e667f3bcdLL; // sqrt(1/2)
    const Bits          k     = (bits - start) >> 52;
    const Number        m =
      internal::same_bits<Number>(((bits - start) & 0xfffffffffffffLL) + start);
    // An integer in the last digits of 1.5 2^52 is that number of units.
    const Number exponent =
      internal::same_bits<Number>(k + 0x4338000000000000LL) - 6755399441055744.;

    const Number s = (m - 1.) / (m + 1.), z = s * s;
    Number       series = broadcast<Number>(1. / 21);
#pragma GCC unroll 16
    for (int n = 19; n >= 3; n -= 2)
      series = series * z + 1. / n;
    // ln 2 as 42 bits, so that their product with k is exact, and the rest
    constexpr double ln2_high = 0x1.62e42fefa38p-1;
    constexpr double ln2_low  = 0x1.ef35793c7673p-45;
    const Number     result   = exponent * ln2_high +
                          (2. * s + (2. * s * z * series + exponent * ln2_low));
    return a > 0. ? result :
                    broadcast<Number>(std::numeric_limits<double>::quiet_NaN());
  }



  /**
   * e^a to two units in the last place where that is a normal number; for
   * smaller and larger a the value at the end of that range. With a = n ln 2 +
   * r, 2^n times the series of e^r up to r^13.
   */
  template <class Number>
  inline Number
  exponential(const Number &a)
  {
    using Bits       = internal::Bits<Number>;
    const Number low = broadcast<Number>(-708.), high = broadcast<Number>(709.);
    const Number x = a < low ? low : a > high ? high : a;
    // An integer in the last digits of 1.5 2^52 is that number of units.
    constexpr double units    = 6755399441055744.;
    const Number     shifted  = x * 1.4426950408889634 + units;
    const Number     n        = shifted - units;
    constexpr double ln2_high = 0x1.62e42fefa38p-1;
    constexpr double ln2_low  = 0x1.ef35793c7673p-45;
    const Number     r        = (x - n * ln2_high) - n * ln2_low;
    Number           series   = broadcast<Number>(1.);
#pragma GCC unroll 16
    for (int k = 13; k >= 1; --k)
      series = 1. + series * r * (1. / k);
    const Bits bits = internal::same_bits<Bits>(shifted);
    return series * internal::same_bits<Number>(internal::as_exponent<Bits>(
                      bits - 0x4338000000000000LL + 1023));
  }



  /** Whether a comparison of packs holds in every lane. */
  template <class Mask>
  inline bool
  all(const Mask &mask)
  {
    if constexpr (sizeof(Mask) == sizeof(bool))
      return mask;
    else
      {
#if defined(__AVX512DQ__)
        if constexpr (sizeof(Mask) == 64)
          {
            typedef long long Bits __attribute__((vector_size(64)));
            return static_cast<unsigned char>(
                     __builtin_ia32_cvtq2mask512(Bits(mask))) == 0xff;
          }
#endif
#if defined(__AVX__)
        if constexpr (sizeof(Mask) == 32)
          return __builtin_ia32_movmskpd256(Pack<4>(mask)) == 0xf;
#endif
        std::int64_t result = -1;
        for (unsigned int i = 0; i < sizeof(Mask) / sizeof(result); ++i)
          result &= mask[i];
        return result != 0;
      }
  }



  /**
   * ln(b/a) of positive numbers, to round-off of (b - a) / a where they differ
   * by less than two per cent: 2 artanh s, s = (b - a) / (b + a), by the series
   * up to s^9.
   */
  template <class Number>
  inline Number
  logarithm_of_ratio(const Number &b, const Number &a)
  {
    const Number s = (b - a) / (b + a), z = s * s;
    if (rarely(!all(z < 1e-4)))
      return logarithm(b / a);
    return 2. * s *
           (1. + z * (1. / 3 + z * (1. / 5 + z * (1. / 7 + z * (1. / 9)))));
  }



  namespace internal
  {
    /**
     * One stage of a transposition in place: exchange the blocks of size
     * @p half off the diagonal.
     */
    template <int width, int half>
    __attribute__((always_inline)) inline void
    exchange_blocks(std::array<Pack<width>, width> &a)
    {
      typename PackType<width>::mask low, high;
      for (int i = 0; i < width; ++i)
        {
          low[i]  = (i & half) ? width + (i ^ half) : i;
          high[i] = (i & half) ? width + i : (i ^ half);
        }
      for (int i = 0; i < width; ++i)
        if (!(i & half))
          {
            const Pack<width> upper = a[i], lower = a[i | half];
            a[i]        = __builtin_shuffle(upper, lower, low);
            a[i | half] = __builtin_shuffle(upper, lower, high);
          }
    }
  } // namespace internal



  /** Lane i of pack j becomes lane j of pack i. */
  template <int width>
  __attribute__((always_inline)) inline void
  transpose(std::array<Pack<width>, width> &a)
  {
    if constexpr (width > widest_pack)
      {
        // four blocks that fit into registers
        std::array<Pack<4>, 4> blocks[2][2];
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j)
            {
              for (int k = 0; k < 4; ++k)
                blocks[i][j][k] = some_lanes<Pack<4>>(a[4 * i + k], 4 * j);
              transpose<4>(blocks[i][j]);
            }
        for (int i = 0; i < 2; ++i)
          for (int k = 0; k < 4; ++k)
            a[4 * i + k] = joined(blocks[0][i][k], blocks[1][i][k]);
        return;
      }
    internal::exchange_blocks<width, 1>(a);
    if constexpr (width >= 4)
      internal::exchange_blocks<width, 2>(a);
    if constexpr (width == 8)
      internal::exchange_blocks<width, 4>(a);
  }



  namespace internal
  {
    /**
     * Lanes without the bit @p half: x summed over that bit; lanes with it:
     * y summed likewise.
     */
    template <int width, int half>
    __attribute__((always_inline)) inline Pack<width>
    fold(const Pack<width> &x, const Pack<width> &y)
    {
      // The first is a selection, which goes where additions go, and not to the
      // one unit that shuffles.
      typename PackType<width>::mask first, second;
      for (int i = 0; i < width; ++i)
        {
          first[i]  = (i & half) ? width + i : i;
          second[i] = (i & half) ? width + (i ^ half) : (i ^ half);
        }
      return __builtin_shuffle(x, y, first) + __builtin_shuffle(x, y, second);
    }
  } // namespace internal



  /** The sums over the lanes of each pack: that of a[i] in lane i. */
  template <std::size_t width>
  __attribute__((always_inline)) inline Pack<int(width)>
  sums_over_lanes(const std::array<Pack<int(width)>, width> &a)
  {
    constexpr int w    = width;
    const auto    four = [&a](const int i) __attribute__((always_inline))
    {
      return internal::fold<w, 2>(internal::fold<w, 1>(a[i], a[i + 1]),
                                  internal::fold<w, 1>(a[i + 2], a[i + 3]));
    };
    if constexpr (width == 4)
      return four(0);
    else
      return internal::fold<w, 4>(four(0), four(4));
  }



  /** The same of half as many packs as they have lanes. */
  __attribute__((always_inline)) inline Pack<4>
  sums_over_lanes(const std::array<Pack<8>, 4> &a)
  {
    const auto folded = internal::fold<8, 2>(internal::fold<8, 1>(a[0], a[1]),
                                             internal::fold<8, 1>(a[2], a[3]));
    return __builtin_shufflevector(folded, folded, 0, 1, 2, 3) +
           __builtin_shufflevector(folded, folded, 4, 5, 6, 7);
  }

  __attribute__((always_inline)) inline Pack<2>
  sums_over_lanes(const std::array<Pack<4>, 2> &a)
  {
    const auto folded = internal::fold<4, 1>(a[0], a[1]);
    return __builtin_shufflevector(folded, folded, 0, 1) +
           __builtin_shufflevector(folded, folded, 2, 3);
  }



  /** The same of twice as many packs as they have lanes. */
  __attribute__((always_inline)) inline Pack<8>
  sums_over_lanes(const std::array<Pack<4>, 8> &a)
  {
    return joined(sums_over_lanes<4>({{a[0], a[1], a[2], a[3]}}),
                  sums_over_lanes<4>({{a[4], a[5], a[6], a[7]}}));
  }



  /** The sums over the lanes of any number of packs. */
  template <class Number, std::size_t n>
  __attribute__((always_inline)) inline std::array<double, n>
  all_sums(const std::array<Number, n> &packs)
  {
    constexpr std::size_t width = pack_width<Number>;
    std::array<double, n> result;
#pragma GCC unroll 8
    for (std::size_t first = 0; first < n; first += width)
      {
        std::array<Number, width> some;
        set_zero(some);
        for (std::size_t i = first; i < n && i < first + width; ++i)
          some[i - first] = packs[i];
        const Number sums = sums_over_lanes(some);
        for (std::size_t i = first; i < n && i < first + width; ++i)
          result[i] = sums[i - first];
      }
    return result;
  }



  /** Which of the first lanes of a pack take part: the tail of a run. */
  template <class Number>
  inline auto
  first_lanes(const int n)
  {
    if constexpr (pack_width<Number> == 1)
      return n > 0;
    else
      {
        typename internal::PackType<pack_width<Number>>::mask lanes;
        for (int i = 0; i < pack_width<Number>; ++i)
          lanes[i] = i;
        return lanes < n;
      }
  }
} // namespace limber

#endif
