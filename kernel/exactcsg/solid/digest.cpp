// SPDX-License-Identifier: Apache-2.0
// The digest of a boundary. docs/digest.md describes the text that is hashed.
#include <openssl/evp.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <string>

#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new()) {
    check(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void add(const std::string& text) {
    check(EVP_DigestUpdate(context_.get(), text.data(), text.size()) == 1);
  }
  std::string hexadecimal() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
    unsigned length = 0;
    check(EVP_DigestFinal_ex(context_.get(), bytes.data(), &length) == 1);
    std::string text;
    for (unsigned i = 0; i < length; ++i) {
      constexpr char digits[] = "0123456789abcdef";
      text += digits[bytes[i] >> 4U];
      text += digits[bytes[i] & 15U];
    }
    return text;
  }

 private:
  static void check(bool ok) {
    if (!ok) throw Error(ErrorId::InternalError, {"SHA-256 of OpenSSL failed", ""});
  }
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  std::unique_ptr<EVP_MD_CTX, Free> context_;
};

// rank[i]: the place of item i in sorted order.
template <class Item, class Less>
std::vector<std::uint32_t> sorted_order(const std::vector<Item>& items, Less less) {
  std::vector<std::uint32_t> order(items.size());
  std::iota(order.begin(), order.end(), 0U);
  if (!std::is_sorted(items.begin(), items.end(), less)) {
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t i, std::uint32_t j) { return less(items[i], items[j]); });
  }
  return order;
}

std::vector<std::uint32_t> inverse_of(const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> rank(order.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) rank[order[k]] = k;
  return rank;
}

// The planes that carry a face, sorted and distinct, and for every plane of the boundary its place.
struct UsedPlanes {
  std::vector<Plane> planes;
  std::vector<std::uint32_t> place;
};

UsedPlanes planes_of_faces(const Boundary& boundary) {
  std::vector<bool> used(boundary.planes.size(), false);
  for (const BoundaryFace& face : boundary.faces) used[face.plane] = true;
  UsedPlanes result{{}, std::vector<std::uint32_t>(boundary.planes.size(), 0)};
  for (const std::uint32_t i : sorted_order(
           boundary.planes, [](const Plane&p, const Plane&q) { return compare(p, q) < 0; })) {
    if (!used[i]) continue;
    if (result.planes.empty() || !(result.planes.back() == boundary.planes[i])) {
      result.planes.push_back(boundary.planes[i]);
    }
    result.place[i] = static_cast<std::uint32_t>(result.planes.size() - 1);
  }
  return result;
}

// The sides of all faces: plane, from, to. Does not depend on how loops are split or where they
// start.
std::vector<std::array<std::uint32_t, 3>> sides_of_faces(const Boundary& boundary,
                                                         const std::vector<std::uint32_t>& rank,
                                                         const UsedPlanes& planes) {
  std::vector<std::array<std::uint32_t, 3>> sides;
  for (const BoundaryFace& face : boundary.faces) {
    for (const std::vector<std::uint32_t>& loop : face.loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        sides.push_back(
            {planes.place[face.plane], rank[loop[k]], rank[loop[(k + 1) % loop.size()]]});
      }
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

}  // namespace

std::string digest(const Boundary& boundary) {
  Sha256 hash;
  hash.add("exactcsg.boundary/1\nvertices " + std::to_string(boundary.vertices.size()) + "\n");
  const std::vector<std::uint32_t> order = sorted_order(
      boundary.vertices, [](const Point3& p, const Point3& q) { return compare(p, q) < 0; });
  for (const std::uint32_t v : order) {
    const Point3& p = boundary.vertices[v];
    hash.add(p.x.get_str() + " " + p.y.get_str() + " " + p.z.get_str() + "\n");
  }

  const std::vector<std::uint32_t> rank = inverse_of(order);
  std::vector<BoundaryEdge> edges;
  edges.reserve(boundary.edges.size());
  for (const BoundaryEdge& e : boundary.edges) {
    edges.push_back({std::min(rank[e.from], rank[e.to]), std::max(rank[e.from], rank[e.to])});
  }
  if (!std::is_sorted(edges.begin(), edges.end())) std::sort(edges.begin(), edges.end());
  hash.add("edges " + std::to_string(edges.size()) + "\n");
  for (const BoundaryEdge& e : edges) {
    hash.add(std::to_string(e.from) + " " + std::to_string(e.to) + "\n");
  }

  const UsedPlanes planes = planes_of_faces(boundary);
  hash.add("planes " + std::to_string(planes.planes.size()) + "\n");
  for (const Plane& p : planes.planes) {
    hash.add(p.a.get_str() + " " + p.b.get_str() + " " + p.c.get_str() + " " + p.d.get_str() +
             "\n");
  }

  const std::vector<std::array<std::uint32_t, 3>> sides = sides_of_faces(boundary, rank, planes);
  hash.add("sides " + std::to_string(sides.size()) + "\n");
  for (const auto& [plane, from, to] : sides) {
    hash.add(std::to_string(plane) + " " + std::to_string(from) + " " + std::to_string(to) + "\n");
  }
  return hash.hexadecimal();
}

}  // namespace exactcsg
