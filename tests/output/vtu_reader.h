#pragma once
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace amontons
{
/// Reads the arrays of a .vtu whose arrays are inline, zlib-compressed and in base64, after VTK's description of its
/// XML formats (header: blocks, block size, size of a partial last block, compressed sizes; coded by itself).
class VtuReader
{
public:
  explicit VtuReader(std::string text)
    : text_(std::move(text))
  {
  }
  [[nodiscard]] const std::string &text() const { return text_; }
  [[nodiscard]] std::vector<double> numbers(const std::string &name) const { return read<double>(name, "Float64"); }
  template<typename T>
  [[nodiscard]] std::vector<T> integers(const std::string &name) const
  {
    return read<T>(name, sizeof(T) == 1 ? "UInt8" : "Int64");
  }

private:
  static std::string decode(const std::string &code)
  {
    static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0;
    int n_bits = 0;
    for (const char c : code)
    {
      if (c == '=')
        break;
      bits = bits << 6 | static_cast<unsigned>(digits.find(c));
      n_bits += 6;
      if (n_bits >= 8)
        bytes += static_cast<char>(bits >> (n_bits -= 8) & 255);
    }
    return bytes;
  }

  static std::uint64_t word(const std::string &bytes, std::size_t i)
  {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + 8 * i, 8);
    return value;
  }

  template<typename T>
  std::vector<T> read(const std::string &name, const std::string &type) const
  {
    const auto found = text_.find("<DataArray type=\"" + type + "\" Name=\"" + name + "\"");
    if (found == std::string::npos)
      throw std::runtime_error("no array " + name + " of " + type);
    const auto begin = text_.find('\n', found) + 1;
    const std::string code = text_.substr(begin, text_.find('\n', begin) - begin);

    const std::uint64_t n_blocks = word(decode(code.substr(0, 12)), 0);
    const std::size_t header_code = (8 * (3 + n_blocks) + 2) / 3 * 4;
    const std::string header = decode(code.substr(0, header_code));
    const std::string compressed = decode(code.substr(header_code));
    std::string bytes;
    std::size_t position = 0;
    for (std::uint64_t block = 0; block < n_blocks; ++block)
    {
      const bool partial = block + 1 == n_blocks && word(header, 2) > 0;
      uLongf size = word(header, partial ? 2 : 1);
      std::string plain(size, '\0');
      const auto compressed_size = word(header, 3 + block);
      if (uncompress(reinterpret_cast<Bytef *>(plain.data()), &size,
                     reinterpret_cast<const Bytef *>(compressed.data() + position), compressed_size) != Z_OK)
        throw std::runtime_error("array " + name + " does not decompress");
      position += compressed_size;
      bytes += plain.substr(0, size);
    }
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

  std::string text_;
};
} // namespace amontons
