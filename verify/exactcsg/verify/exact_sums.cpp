// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/exact_sums.hpp"

#include "exactcsg/number/enclosure.hpp"

namespace exactcsg::verify {
namespace {

constexpr std::size_t longest_denominator = 1U << 13U;  // bits
constexpr mp_bitcnt_t decimal_bits = 512;
constexpr int decimal_digits = 17;

// Arithmetic modulo a 61-bit prime.
__extension__ using Wide = unsigned __int128;

struct Field {
  std::uint64_t p;
  std::uint64_t add(std::uint64_t a, std::uint64_t b) const { return (a + b) % p; }
  std::uint64_t subtract(std::uint64_t a, std::uint64_t b) const { return (a + p - b) % p; }
  std::uint64_t multiply(std::uint64_t a, std::uint64_t b) const {
    return static_cast<std::uint64_t>(static_cast<Wide>(a) * b % p);
  }
  std::uint64_t inverse(std::uint64_t a) const {
    std::uint64_t result = 1;
    for (std::uint64_t e = p - 2; e != 0; e >>= 1U) {
      if ((e & 1U) != 0) result = multiply(result, a);
      a = multiply(a, a);
    }
    return result;
  }
  // nullopt: the denominator is divisible by p.
  std::optional<std::uint64_t> of(const Rational& value) const {
    const std::uint64_t d = mpz_fdiv_ui(value.get_den_mpz_t(), p);
    if (d == 0) return std::nullopt;
    return multiply(mpz_fdiv_ui(value.get_num_mpz_t(), p), inverse(d));
  }
};

template <class Number>
struct Triple {
  Number x, y, z;
};

// Six times the volume, in any ring: sum over the faces of p0 . sum of p_i x p_(i+1).
template <class Number, class Add, class Subtract, class Multiply>
Number six_volumes(const std::vector<Triple<Number>>& points,
                   const std::vector<OrientedFace>& faces, Number zero, Add add, Subtract subtract,
                   Multiply multiply) {
  Number sum = zero;
  for (const OrientedFace& face : faces) {
    if (face.cycles->empty() || face.cycles->front().empty()) continue;
    Triple<Number> area{zero, zero, zero};
    for (const auto& cycle : *face.cycles) {
      for (std::size_t i = 0; i < cycle.size(); ++i) {
        const auto& a = points[cycle[i]];
        const auto& b = points[cycle[(i + 1) % cycle.size()]];
        area.x = add(area.x, subtract(multiply(a.y, b.z), multiply(a.z, b.y)));
        area.y = add(area.y, subtract(multiply(a.z, b.x), multiply(a.x, b.z)));
        area.z = add(area.z, subtract(multiply(a.x, b.y), multiply(a.y, b.x)));
      }
    }
    const auto& origin = points[face.cycles->front().front()];
    const Number part = add(add(multiply(origin.x, area.x), multiply(origin.y, area.y)),
                            multiply(origin.z, area.z));
    sum = face.sense < 0 ? subtract(sum, part) : add(sum, part);
  }
  return sum;
}

template <class Number>
Number six_volumes(const std::vector<Triple<Number>>& points,
                   const std::vector<OrientedFace>& faces, Number zero) {
  return six_volumes(
      points, faces, zero, [](const Number& a, const Number& b) { return Number(a + b); },
      [](const Number& a, const Number& b) { return Number(a - b); },
      [](const Number& a, const Number& b) { return Number(a * b); });
}

// nullopt: longer than the limit.
std::optional<Integer> common_denominator(const std::vector<Point3>& points) {
  Integer result = 1;
  for (const Point3& p : points) {
    for (const Rational* c : {&p.x, &p.y, &p.z}) {
      if (mpz_divisible_p(result.get_mpz_t(), c->get_den_mpz_t()) != 0) continue;
      result = lcm(result, c->get_den());
      if (mpz_sizeinbase(result.get_mpz_t(), 2) > longest_denominator) return std::nullopt;
    }
  }
  return result;
}

Rational exact_sum(const std::vector<Point3>& points, const std::vector<OrientedFace>& faces,
                   const Integer& denominator) {
  std::vector<Triple<Integer>> scaled;
  scaled.reserve(points.size());
  const auto scale = [&](const Rational& c) {
    return Integer(c.get_num() * (denominator / c.get_den()));
  };
  for (const Point3& p : points) scaled.push_back({scale(p.x), scale(p.y), scale(p.z)});
  Rational result(six_volumes<Integer>(scaled, faces, 0),
                  Integer(6 * denominator * denominator * denominator));
  result.canonicalize();
  return result;
}

std::optional<std::uint64_t> residue(const std::vector<Point3>& points,
                                     const std::vector<OrientedFace>& faces, const Field& field) {
  std::vector<Triple<std::uint64_t>> mapped;
  mapped.reserve(points.size());
  for (const Point3& p : points) {
    const auto x = field.of(p.x);
    const auto y = field.of(p.y);
    const auto z = field.of(p.z);
    if (!x || !y || !z) return std::nullopt;
    mapped.push_back({*x, *y, *z});
  }
  return six_volumes<std::uint64_t>(
      mapped, faces, 0, [&](std::uint64_t a, std::uint64_t b) { return field.add(a, b); },
      [&](std::uint64_t a, std::uint64_t b) { return field.subtract(a, b); },
      [&](std::uint64_t a, std::uint64_t b) { return field.multiply(a, b); });
}

std::string approximate_decimal(const std::vector<Point3>& points,
                                const std::vector<OrientedFace>& faces) {
  std::vector<Triple<mpf_class>> rounded;
  rounded.reserve(points.size());
  for (const Point3& p : points) {
    rounded.push_back(
        {mpf_class(p.x, decimal_bits), mpf_class(p.y, decimal_bits), mpf_class(p.z, decimal_bits)});
  }
  const mpf_class zero(0, decimal_bits);
  const mpf_class sum = six_volumes<mpf_class>(rounded, faces, zero);
  return to_decimal(Rational(mpf_class(sum / 6)), decimal_digits);
}

std::array<Field, residue_count> fields() {
  gmp_randclass random(gmp_randinit_default);
  random.seed(20240229);
  std::array<Field, residue_count> result{};
  for (Field& field : result) {
    Integer candidate = random.get_z_bits(60) + (Integer(1) << 60U);
    mpz_nextprime(candidate.get_mpz_t(), candidate.get_mpz_t());
    field.p = candidate.get_ui();
  }
  return result;
}

}  // namespace

VolumeSum sum_volume(const std::vector<Point3>& points, const std::vector<OrientedFace>& faces) {
  VolumeSum result;
  if (const auto denominator = common_denominator(points)) {
    result.exact = exact_sum(points, faces, *denominator);
    result.decimal = to_decimal(*result.exact, decimal_digits);
  } else {
    result.decimal = approximate_decimal(points, faces);
  }
  const auto primes = fields();
  for (std::size_t i = 0; i < residue_count; ++i) {
    // A prime that divides a denominator tells nothing; a chance of 2^-50, the others remain.
    result.residues[i] = residue(points, faces, primes[i]).value_or(0);
  }
  return result;
}

bool balances(const std::vector<VolumeSum>& left, const std::vector<VolumeSum>& right) {
  const auto primes = fields();
  std::array<std::uint64_t, residue_count> balance{};
  Rational exact = 0;
  bool all_exact = true;
  for (const auto* side : {&left, &right}) {
    for (const VolumeSum& sum : *side) {
      all_exact = all_exact && sum.exact.has_value();
      if (all_exact) exact += side == &left ? *sum.exact : Rational(-*sum.exact);
      for (std::size_t i = 0; i < residue_count; ++i) {
        balance[i] = side == &left ? primes[i].add(balance[i], sum.residues[i])
                                   : primes[i].subtract(balance[i], sum.residues[i]);
      }
    }
  }
  if (all_exact) return exact == 0;
  return balance == std::array<std::uint64_t, residue_count>{};
}

bool operator==(const VolumeSum& a, const VolumeSum& b) {
  if (a.exact && b.exact) return *a.exact == *b.exact;
  return a.residues == b.residues;
}

}  // namespace exactcsg::verify
