// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_lazy_array_h
#define limber_base_lazy_array_h

#include <sys/mman.h>

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace limber
{
  /**
   * Array of zeros that the system maps page by page: pages that nobody has
   * written to take no memory. For tables over the whole box of which a step
   * needs only the part with material. Aligned to a page.
   */
  template <typename Number>
  class LazyArray
  {
    static_assert(std::is_trivial<Number>::value, "zero bytes are its zero");

  public:
    LazyArray() = default;

    explicit LazyArray(const std::size_t size)
      : numbers(map(size), Unmap{size * sizeof(Number)})
      , n(size)
    {}

    /** Forget everything: @p size zeros. */
    void
    reinit(const std::size_t size)
    {
      *this = {};
      *this = LazyArray(size);
    }

    Number *
    data()
    {
      return numbers.get();
    }

    const Number *
    data() const
    {
      return numbers.get();
    }

    std::size_t
    size() const
    {
      return n;
    }

    Number &
    operator[](const std::size_t i)
    {
      return numbers[i];
    }

    const Number &
    operator[](const std::size_t i) const
    {
      return numbers[i];
    }

  private:
    struct Unmap
    {
      void
      operator()(Number *const begin) const
      {
        munmap(begin, bytes);
      }

      std::size_t bytes = 0;
    };

    static Number *
    map(const std::size_t size)
    {
      if (size == 0)
        return nullptr;
      void *const begin = mmap(nullptr,
                               size * sizeof(Number),
                               PROT_READ | PROT_WRITE,
                               MAP_PRIVATE | MAP_ANONYMOUS,
                               -1,
                               0);
      if (begin == MAP_FAILED)
        throw std::bad_alloc();
      return static_cast<Number *>(begin);
    }

    std::unique_ptr<Number[], Unmap> numbers;
    std::size_t                      n = 0;
  };
} // namespace limber

#endif
