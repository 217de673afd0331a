// TIFF stacks: a page is a slice; voxel sizes as ImageJ writes them. libtiff reads strips, tiles and compressed data.
#include "tiff.h"

#include <bit>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <map>
#include <memory>

#include <tiffio.h>

#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"
#include "vmesh/core/memory.h"

#include "image_header.h"

namespace vmesh::image {
namespace {

/// A file in memory, for libtiff.
struct MemoryFile {
  std::string_view bytes;
  std::uint64_t at = 0;

  static tmsize_t read(thandle_t handle, void* buffer, tmsize_t size) {
    auto& [bytes, at] = *static_cast<MemoryFile*>(handle);
    if (at >= bytes.size()) return 0;
    const std::size_t count = bytes.copy(static_cast<char*>(buffer), static_cast<std::size_t>(size), at);
    at += count;
    return static_cast<tmsize_t>(count);
  }
  static tmsize_t write(thandle_t, void*, tmsize_t) { return -1; }
  static toff_t seek(thandle_t handle, toff_t offset, int from) {
    auto& [bytes, at] = *static_cast<MemoryFile*>(handle);
    if (from == SEEK_SET) at = offset;
    if (from == SEEK_CUR) at += offset;
    if (from == SEEK_END) at = bytes.size() + offset;
    return at;
  }
  static toff_t size(thandle_t handle) { return static_cast<MemoryFile*>(handle)->bytes.size(); }
  static int close(thandle_t) { return 0; }
};

/// What libtiff says first of what is wrong.
struct TiffErrors {
  std::string first;

  static int remember(TIFF*, void* errors, const char*, const char* format, va_list arguments) {
    char text[256];
    std::vsnprintf(text, sizeof text, format, arguments);
    std::string& first = static_cast<TiffErrors*>(errors)->first;
    if (first.empty()) first = cited(text);
    return 1;
  }
  static int ignore(TIFF*, void*, const char*, const char*, va_list) { return 1; }
};

/// In one of ImageJ's units; 0 for one that is no length, such as pixels.
double millimetres_in(const std::string& unit) {
  static const std::map<std::string_view, double> kUnits = {
      {"nm", 1e-6},       {"um", 1e-3}, {"micron", 1e-3},  {"microns", 1e-3}, {"\xC2\xB5m", 1e-3}, {"\xB5m", 1e-3},
      {"\\u00B5m", 1e-3}, {"mm", 1},    {"millimeter", 1}, {"cm", 10},        {"m", 1000},         {"inch", 25.4}};
  const auto found = kUnits.find(unit);
  return found == kUnits.end() ? 0 : found->second;
}

/// The properties of a page; those of a stack must be equal.
struct TiffPage {
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 0, format = 0, samples = 0, compression = 0;

  bool operator==(const TiffPage& other) const {
    return width == other.width && height == other.height && bits == other.bits && format == other.format &&
           samples == other.samples;
  }
};

class TiffStack {
 public:
  TiffStack(const std::string& name, std::optional<std::string_view> content)
      : name_(name), memory_{content.value_or("")}, tiff_(open(content.has_value())) {
    if (!tiff_) fail("this is not a TIFF file that can be read");
  }

  void read(const ImageBegin& begin, const SliceVisitor& visit, const ImageReadOptions& options) {
    page_ = page();
    type_ = type();
    pages_ = TIFFNumberOfDirectories(tiff_.get());  // up to the first that cannot be read
    if (!errors_.first.empty()) fail_at(pages_, "it cannot be read; the file is broken or incomplete");
    check_size();
    const ImageFrame image = frame(options);
    begin(image);
    std::vector<char> stored(page_bytes());
    std::vector<float> values(std::size_t{page_.width} * page_.height);
    for (std::uint32_t k = 0; k < pages_; ++k) {
      if (k == 0 ? !TIFFSetDirectory(tiff_.get(), 0) : !TIFFReadDirectory(tiff_.get())) fail_at(k, "it cannot be read");
      if (!(page() == page_)) fail_at(k, "its size or type is not that of the first page; store the stack alone");
      TIFFIsTiled(tiff_.get()) ? read_tiles(k, stored) : read_strips(k, stored);
      read_numbers({stored.data(), stored.size()}, {type_, std::endian::native == std::endian::big}, values, name_,
                   values.size() * k);
      visit(k, values);
    }
  }

 private:
  struct Close {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(name_ + ": " + what + (errors_.first.empty() ? "" : " (libtiff: " + errors_.first + ")"));
  }
  [[noreturn]] void fail_at(std::uint32_t page, const std::string& what) const {
    fail("page " + std::to_string(page) + ": " + what);
  }

  TIFF* open(bool in_memory) {
    file_size_ = in_memory ? memory_.bytes.size() : InputFile(name_).size();
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> settings(TIFFOpenOptionsAlloc(),
                                                                                TIFFOpenOptionsFree);
    TIFFOpenOptionsSetErrorHandlerExtR(settings.get(), TiffErrors::remember, &errors_);
    TIFFOpenOptionsSetWarningHandlerExtR(settings.get(), TiffErrors::ignore, nullptr);
    // m: not mapped into memory, where a file that others shorten would end the program.
    if (!in_memory) return TIFFOpenExt(name_.c_str(), "rm", settings.get());
    return TIFFClientOpenExt(name_.c_str(), "rm", &memory_, MemoryFile::read, MemoryFile::write, MemoryFile::seek,
                             MemoryFile::close, MemoryFile::size, nullptr, nullptr, settings.get());
  }

  template <class Value>
  Value field(std::uint32_t tag, Value otherwise) const {
    Value value = otherwise;
    return TIFFGetFieldDefaulted(tiff_.get(), tag, &value) ? value : otherwise;
  }

  TiffPage page() const {
    return {field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0),      field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0),
            field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1),   field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, 1),
            field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1), field<std::uint16_t>(TIFFTAG_COMPRESSION, 1)};
  }

  NumberType type() const {
    static const std::map<std::pair<int, int>, NumberType> kTypes = {
        {{SAMPLEFORMAT_UINT, 8}, NumberType::u8},     {{SAMPLEFORMAT_UINT, 16}, NumberType::u16},
        {{SAMPLEFORMAT_UINT, 32}, NumberType::u32},   {{SAMPLEFORMAT_INT, 8}, NumberType::i8},
        {{SAMPLEFORMAT_INT, 16}, NumberType::i16},    {{SAMPLEFORMAT_INT, 32}, NumberType::i32},
        {{SAMPLEFORMAT_IEEEFP, 32}, NumberType::f32}, {{SAMPLEFORMAT_IEEEFP, 64}, NumberType::f64}};
    if (page_.samples != 1)
      throw Unsupported(name_ + ": has " + std::to_string(page_.samples) +
                        " numbers per voxel; store one channel, in grey or labels");
    const auto found = kTypes.find({page_.format, page_.bits});
    if (found == kTypes.end() || field<std::uint32_t>(TIFFTAG_IMAGEDEPTH, 1) != 1)
      throw Unsupported(name_ + ": voxels of " + std::to_string(page_.bits) +
                        " bits of this kind are not supported; store 8, 16 or 32 bits or float");
    return found->second;
  }

  std::size_t page_bytes() const { return std::size_t{page_.width} * page_.height * size_of(type_); }

  /// Bytes that a file of this size may hold when it is unpacked.
  double most_bytes() const {
    const bool is_plain = page_.compression == COMPRESSION_NONE;
    const bool is_usual = page_.compression == COMPRESSION_LZW || page_.compression == COMPRESSION_ADOBE_DEFLATE ||
                          page_.compression == COMPRESSION_DEFLATE || page_.compression == COMPRESSION_PACKBITS;
    constexpr double kByUsual = 1300, kByOthers = 1e5;  // bytes from one, at most; by LZW and by Zstandard
    return static_cast<double>(file_size_) * (is_plain ? 1 : is_usual ? kByUsual : kByOthers);
  }

  void check_size() const {
    const double page = static_cast<double>(page_.width) * page_.height * static_cast<double>(size_of(type_));
    if (!(page > 0)) fail("the header gives no valid number of voxels");
    const bool is_tiled = TIFFIsTiled(tiff_.get()) != 0;
    const double tile = is_tiled ? static_cast<double>(TIFFTileSize64(tiff_.get())) : 0;
    if (page * pages_ > most_bytes() || tile > most_bytes())
      fail("the header claims " + std::to_string(pages_) + " pages of " + std::to_string(page_.width) + " x " +
           std::to_string(page_.height) + " voxels, more than the file can hold; it is broken or incomplete");
    require_memory(
        2 * page + 4 * static_cast<double>(page_.width) * page_.height,
        name_ + ": a page of " + std::to_string(page_.width) + " x " + std::to_string(page_.height) + " voxels",
        "crop it to the vessels");
  }

  void read_strips(std::uint32_t k, std::vector<char>& stored) const {
    const std::size_t row = std::size_t{page_.width} * size_of(type_);
    const std::size_t rows = std::min(field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, page_.height), page_.height);
    std::uint32_t strip = 0;
    for (std::size_t first = 0; first < page_.height; first += rows, ++strip) {
      const auto size = static_cast<tmsize_t>(std::min(rows, page_.height - first) * row);
      if (rows == 0 || TIFFReadEncodedStrip(tiff_.get(), strip, stored.data() + first * row, size) != size)
        fail_at(k, "voxels are missing or damaged; the file is broken or incomplete");
    }
  }

  void read_tiles(std::uint32_t k, std::vector<char>& stored) const {
    const auto wide = field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0), high = field<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
    const std::size_t size = size_of(type_), bytes = std::size_t{wide} * high * size;
    if (bytes == 0 || static_cast<tmsize_t>(bytes) != TIFFTileSize(tiff_.get()))
      fail_at(k, "its tiles have no valid size");
    std::vector<char> tile(bytes);
    for (std::uint32_t y = 0; y < page_.height; y += high) {
      for (std::uint32_t x = 0; x < page_.width; x += wide) {
        const std::uint32_t number = TIFFComputeTile(tiff_.get(), x, y, 0, 0);
        if (TIFFReadEncodedTile(tiff_.get(), number, tile.data(), static_cast<tmsize_t>(bytes)) !=
            static_cast<tmsize_t>(bytes))
          fail_at(k, "voxels are missing or damaged; the file is broken or incomplete");
        const std::size_t columns = std::min(wide, page_.width - x), rows = std::min(high, page_.height - y);
        for (std::size_t r = 0; r < rows; ++r)
          std::copy_n(tile.data() + r * wide * size, columns * size,
                      stored.data() + ((y + r) * page_.width + x) * size);
        if (page_.width - x <= wide) break;  // the next x may be beyond 32 bits
      }
      if (page_.height - y <= high) break;
    }
  }

  ImageFrame frame(const ImageReadOptions& options) const {
    ImageFrame image;
    image.integer = is_integer(type_);
    image.frame.size = {page_.width, page_.height, pages_};
    image.frame.steps = voxel_size(options, image.warnings).asDiagonal();
    image.warnings.push_back(name_ + ": TIFF has no patient frame; LPS is assumed");
    check_place(image.frame.origin, image.frame.steps, name_);
    return image;
  }

  Vec3 voxel_size(const ImageReadOptions& options, std::vector<std::string>& warnings) const {
    const std::optional<Vec3> said = size_by_imagej();
    if (options.voxel_size) {
      if (said && !said->isApprox(*options.voxel_size))
        warnings.push_back(name_ + ": the file says another size of voxels; taken as requested");
      return *options.voxel_size;
    }
    if (said) return *said;
    warnings.push_back(name_ + ": gives no size of voxels; 1 mm is assumed (set it with --voxel-size)");
    return Vec3::Ones();
  }

  /// The lines "name=value" of ImageJ's description; empty without.
  std::map<std::string, std::string, std::less<>> description() const {
    std::map<std::string, std::string, std::less<>> entries;
    const char* text = nullptr;
    TIFFSetDirectory(tiff_.get(), 0);
    if (!TIFFGetField(tiff_.get(), TIFFTAG_IMAGEDESCRIPTION, &text) || text == nullptr) return entries;
    std::string_view rest(text), line;
    if (!rest.starts_with("ImageJ=")) return entries;
    while (take_line(rest, line)) {
      const std::size_t equals = line.find('=');
      if (equals != std::string_view::npos) entries.emplace(line.substr(0, equals), line.substr(equals + 1));
    }
    return entries;
  }

  /// In mm; nullopt if the file does not say it. Throws Unsupported for what is more than one stack.
  std::optional<Vec3> size_by_imagej() const {
    const auto entries = description();
    const auto number = [&](const char* key, double otherwise) {
      const auto found = entries.find(key);
      if (found == entries.end()) return otherwise;
      const std::vector<double> numbers = numbers_in(found->second, name_, key);
      return numbers.size() == 1 ? numbers[0] : otherwise;
    };
    for (const char* key : {"channels", "frames"}) {
      if (number(key, 1) != 1)
        throw Unsupported(name_ + ": has " + cited(entries.find(key)->second) + " " + key + "; store one stack");
    }
    if (number("images", pages_) != pages_)
      throw Unsupported(name_ + ": ImageJ stored " + cited(entries.find("images")->second) + " slices in " +
                        std::to_string(pages_) + " pages; store it as .nii or .nrrd, or in less than 4 GB");
    const auto written = entries.find("unit");
    if (written == entries.end()) return std::nullopt;
    const double unit = millimetres_in(written->second);
    const float x = field(TIFFTAG_XRESOLUTION, 0.0f), y = field(TIFFTAG_YRESOLUTION, 0.0f);
    if (unit == 0 || !(x > 0) || !(y > 0)) return std::nullopt;
    return unit * Vec3(1.0 / x, 1.0 / y, std::abs(number("spacing", 1)));
  }

  const std::string& name_;
  MemoryFile memory_;
  TiffErrors errors_;
  std::uint64_t file_size_ = 0;
  std::unique_ptr<TIFF, Close> tiff_;
  TiffPage page_;
  NumberType type_ = NumberType::u8;
  std::uint32_t pages_ = 0;
};

}  // namespace

void read_tiff(const std::string& source, std::optional<std::string_view> content, const ImageBegin& begin,
               const SliceVisitor& visit, const ImageReadOptions& options) {
  TiffStack(source, content).read(begin, visit, options);
}

}  // namespace vmesh::image
