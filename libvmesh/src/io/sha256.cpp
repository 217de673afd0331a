#include "vmesh/io/sha256.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "vmesh/core/input_file.h"

namespace vmesh {
namespace {

using Word = std::uint32_t;

/// The first 32 bits of the fractional part of a root of n.
Word fraction(double root) { return static_cast<Word>((root - std::floor(root)) * 4294967296.0); }

struct Constants {
  std::array<Word, 64> round{};   // of the cube roots of the first primes
  std::array<Word, 8> initial{};  // of the square roots

  Constants() {
    std::size_t count = 0;
    for (int n = 2; count < round.size(); ++n) {
      bool is_prime = true;
      for (int d = 2; d * d <= n; ++d) is_prime = is_prime && n % d != 0;
      if (!is_prime) continue;
      if (count < initial.size()) initial[count] = fraction(std::sqrt(n));
      round[count++] = fraction(std::cbrt(n));
    }
  }
};

const Constants& constants() {
  static const Constants instance;
  return instance;
}

/// NIST FIPS 180-4, section 6.2. Why not OpenSSL: it was a dependency for these 60 lines.
class Sha256 {
 public:
  void add(const char* bytes, std::size_t count) {
    length_ += count;
    while (count > 0) {
      const std::size_t taken = std::min(count, block_.size() - filled_);
      std::memcpy(block_.data() + filled_, bytes, taken);
      filled_ += taken;
      bytes += taken;
      count -= taken;
      if (filled_ < block_.size()) return;
      filled_ = 0;
      take_block();
    }
  }

  std::string finish() {
    const std::uint64_t bits = 8 * length_;
    add(0x80);
    while (filled_ != 56) add(0);
    for (int shift = 56; shift >= 0; shift -= 8) add(static_cast<unsigned char>(bits >> shift));
    std::string text;
    for (const Word word : state_) {
      for (int shift = 28; shift >= 0; shift -= 4) text += "0123456789abcdef"[word >> shift & 15];
    }
    return text;
  }

 private:
  void add(unsigned char byte) {
    block_[filled_++] = byte;
    if (filled_ < block_.size()) return;
    filled_ = 0;
    take_block();
  }

  void take_block() {
    const auto sigma = [](Word x, int a, int b, int shift) { return std::rotr(x, a) ^ std::rotr(x, b) ^ (x >> shift); };
    const auto sum = [](Word x, int a, int b, int c) { return std::rotr(x, a) ^ std::rotr(x, b) ^ std::rotr(x, c); };
    std::array<Word, 64> w;
    for (std::size_t t = 0; t < 16; ++t)
      w[t] =
          Word{block_[4 * t]} << 24 | Word{block_[4 * t + 1]} << 16 | Word{block_[4 * t + 2]} << 8 | block_[4 * t + 3];
    for (std::size_t t = 16; t < 64; ++t)
      w[t] = sigma(w[t - 2], 17, 19, 10) + w[t - 7] + sigma(w[t - 15], 7, 18, 3) + w[t - 16];
    const std::array<Word, 64>& round = constants().round;
    auto [a, b, c, d, e, f, g, h] = state_;
    for (std::size_t t = 0; t < 64; ++t) {
      const Word first = h + sum(e, 6, 11, 25) + ((e & f) ^ (~e & g)) + round[t] + w[t];
      const Word second = sum(a, 2, 13, 22) + ((a & b) ^ (a & c) ^ (b & c));
      h = g, g = f, f = e, e = d + first, d = c, c = b, b = a, a = first + second;
    }
    const std::array<Word, 8> worked = {a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < 8; ++i) state_[i] += worked[i];
  }

  std::array<Word, 8> state_ = constants().initial;
  std::array<unsigned char, 64> block_{};
  std::size_t filled_ = 0;
  std::uint64_t length_ = 0;  // bytes
};

}  // namespace

std::string sha256_of(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes.data(), bytes.size());
  return hash.finish();
}

std::string sha256_of_file(const std::filesystem::path& path) {
  InputFile file(path);
  Sha256 hash;
  std::vector<char> block(1 << 16);
  while (const std::size_t count = file.read(block)) hash.add(block.data(), count);
  return hash.finish();
}

}  // namespace vmesh
