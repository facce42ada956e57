#pragma once
#include <cstddef>
#include <new>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace amontons
{
/// Asks for large pages where there is much to allocate: the first touch of a page costs about a microsecond, which at
/// a hundred bytes per node is a large part of a detection. A wish, no more: without large pages all is the same.
template<typename T>
struct LargePageAllocator
{
  using value_type = T;

  LargePageAllocator() = default;
  template<typename Other>
  LargePageAllocator(const LargePageAllocator<Other> &)
  {
  }

  T *allocate(std::size_t n)
  {
    const std::size_t bytes = n * sizeof(T);
    void *memory = ::operator new(bytes, alignment(bytes));
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    if (bytes >= much)
      ::madvise(memory, bytes / page * page, MADV_HUGEPAGE);
#endif
    return static_cast<T *>(memory);
  }
  void deallocate(T *memory, std::size_t n)
  {
    ::operator delete(memory, alignment(n * sizeof(T)));
  }

  template<typename Other>
  bool operator==(const LargePageAllocator<Other> &) const
  {
    return true;
  }

private:
  static constexpr std::size_t page = std::size_t{2} << 20, much = 2 * page;
  static std::align_val_t alignment(std::size_t bytes)
  {
    return std::align_val_t{bytes >= much ? page : alignof(T)};
  }
};

template<typename T>
using LargeVector = std::vector<T, LargePageAllocator<T>>;
} // namespace amontons
