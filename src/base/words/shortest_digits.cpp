// The digits of numbers, for number_text.f90: std::to_chars finds the shortest decimal that is read back as the same double.
#include <charconv>
#include <cmath>
#include <cstring>

// Without an exponent from 0.0001 to 999999, beyond where this is shorter; not from 1e16 on, where it would have more digits
// than read back.
static char *write_number(char *first, char *last, double value)
{
  const double size = std::fabs(value);
  if (size >= 1e-4 && size < 1e6) return std::to_chars(first, last, value, std::chars_format::fixed).ptr;
  if (size >= 1e16) return std::to_chars(first, last, value, std::chars_format::scientific).ptr;
  return std::to_chars(first, last, value).ptr;
}

// Numbers at the right ends of fields of `width` characters, which fit the longest of all. Zero has no sign: -0 would make
// equal tables differ.
extern "C" void flexmech_write_numbers(const double *values, int count, int width, char *text)
{
  for (int i = 0; i < count; ++i, text += width) {
    char digits[32];
    const int length = static_cast<int>(write_number(digits, digits + sizeof digits, values[i] + 0.0) - digits);
    std::memset(text, ' ', width - length);
    std::memcpy(text + width - length, digits, length);
  }
}

// The double nearest to a number of so many significant digits; near the largest double the number itself.
extern "C" double flexmech_rounded(double value, int digits)
{
  char text[32];
  const char *end = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits - 1).ptr;
  std::from_chars(text, end, value);
  return value;
}
