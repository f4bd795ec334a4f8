// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/problem/image.h>

#include <png.h>

#include <csetjmp>
#include <cstdint>
#include <cstring>

/** @file Images in the format PNG, by libpng. */
namespace limber
{
  namespace
  {
    /**
     * The pixels of a PNG file as red, green, blue and opacity of 16 bits each.
     * libpng reports errors by a jump, so whatever it changes is a member, and
     * nothing in between has a destructor.
     */
    class PngPixels
    {
    public:
      explicit PngPixels(const std::string &bytes)
        : bytes(bytes)
      {}

      PngPixels(const PngPixels &) = delete;

      ~PngPixels()
      {
        png_destroy_read_struct(&reader, &info, nullptr);
      }

      /** False if the file is damaged or too large; @p message says why. */
      bool
      read()
      {
        reader = png_create_read_struct(PNG_LIBPNG_VER_STRING,
                                        this,
                                        &PngPixels::fail,
                                        &PngPixels::ignore);
        info   = reader == nullptr ? nullptr : png_create_info_struct(reader);
        if (info == nullptr)
          return false;
        if (setjmp(png_jmpbuf(reader)) != 0)
          return false;
        png_set_read_fn(reader, this, &PngPixels::give_bytes);
        png_read_info(reader, info);
        is_deep = png_get_bit_depth(reader, info) == 16;
        size    = {{png_get_image_width(reader, info),
                    png_get_image_height(reader, info)}};
        if (std::uint64_t(size[0]) * size[1] > most_pixels)
          png_error(reader, "more than 1e8 pixels");
        png_set_expand_16(reader);
        png_set_gray_to_rgb(reader);
        png_set_add_alpha(reader, opaque, PNG_FILLER_AFTER);
        png_set_interlace_handling(reader);
        png_read_update_info(reader, info);
        if (png_get_rowbytes(reader, info) != std::size_t(8) * size[0])
          png_error(reader, "an unknown layout of pixels");
        data.resize(std::size_t(8) * size[0] * size[1]);
        rows.resize(size[1]);
        for (std::size_t row = 0; row < size[1]; ++row)
          rows[row] = &data[8 * size[0] * row];
        png_read_image(reader, rows.data());
        png_read_end(reader, nullptr);
        return true;
      }

      /**
       * Grey of a pixel, in row-by-row order from the upper left corner: the
       * luminance (ITU-R BT.709) upon white, up to 255, or to 65535 in a file
       * of 16 bits.
       */
      double
      grey(const std::size_t pixel) const
      {
        const auto channel = [&](const int c) {
          const png_byte *const from = &data[8 * pixel + 2 * c];
          return 256. * from[0] + from[1];
        };
        const double red = channel(0), green = channel(1), blue = channel(2),
                     opacity = channel(3) / opaque;
        const bool   is_grey = red == green && green == blue;
        const double luminance =
          is_grey ? red : 0.2126 * red + 0.7152 * green + 0.0722 * blue;
        return (opacity * luminance + (1 - opacity) * opaque) /
               (is_deep ? 1 : 257);
      }

      std::array<unsigned int, 2> size{};
      std::string                 message = "it cannot be read";

    private:
      static constexpr std::uint64_t most_pixels = 100000000;
      static constexpr unsigned int  opaque      = 65535;

      [[noreturn]] static void
      fail(png_structp reader, png_const_charp what)
      {
        static_cast<PngPixels *>(png_get_error_ptr(reader))->message = what;
        png_longjmp(reader, 1);
      }

      // Of a colour profile or a comment, say: nothing that changes a pixel.
      static void
      ignore(png_structp, png_const_charp)
      {}

      static void
      give_bytes(png_structp reader, png_bytep to, png_size_t n)
      {
        auto &pixels = *static_cast<PngPixels *>(png_get_io_ptr(reader));
        if (pixels.bytes.size() - pixels.next < n)
          png_error(reader, "it ends too early");
        std::memcpy(to, &pixels.bytes[pixels.next], n);
        pixels.next += n;
      }

      const std::string     &bytes;
      std::size_t            next    = 0; // byte
      bool                   is_deep = false;
      png_structp            reader  = nullptr;
      png_infop              info    = nullptr;
      std::vector<png_byte>  data;
      std::vector<png_bytep> rows;
    };
  } // namespace



  bool
  is_png(const InputFile &file)
  {
    return png_sig_cmp(reinterpret_cast<png_const_bytep>(file.bytes.data()),
                       0,
                       std::min<std::size_t>(file.bytes.size(), 8)) == 0;
  }



  void
  read_png(const InputFile &file, Voxels<2> &voxels)
  {
    PngPixels pixels(file.bytes);
    if (!pixels.read())
      throw InputError(
        "The image " + file.name() +
        " is a PNG file that libpng cannot read: " + pixels.message +
        ". Usually it was cut off while it was copied. Write it "
        "anew.");
    voxels.start(pixels.size);
    for (std::size_t i = 0; i < voxels.filled.size(); ++i)
      {
        const std::size_t row = pixels.size[1] - 1 - i / pixels.size[0];
        voxels.set(row * pixels.size[0] + i % pixels.size[0], pixels.grey(i));
      }
  }
} // namespace limber
