/* The types and shapes of HDF5: see hdf_types.h. */
#include "hdf_types.h"

#include <math.h>
#include <string.h>

/* ---- shapes ---- */

bool gonio_i_hdf_read_space(gonio_i_hdf_cursor body, gonio_i_hdf_space *space)
{
    enum { NONE = 2 };
    const uint64_t most = SIZE_MAX >> 16; /* times the size of an element fits */
    const uint64_t version = gonio_i_hdf_number(&body, 1);
    const uint64_t rank = gonio_i_hdf_number(&body, 1);
    gonio_i_hdf_take(&body, 1);
    const uint64_t kind = gonio_i_hdf_number(&body, 1);
    if (version < 1 || version > 2 || rank > GONIO_I_HDF_RANK) {
        return false;
    }
    gonio_i_hdf_take(&body, version == 1 ? 4 : 0);
    *space = (gonio_i_hdf_space){.rank = (int)rank, .count = version == 2 && kind == NONE ? 0 : 1};
    for (uint64_t k = 0; k < rank; k++) {
        const uint64_t extent = gonio_i_hdf_number(&body, 8);
        if (extent > most || (extent > 0 && space->count > most / extent)) {
            return false;
        }
        space->extent[k] = (size_t)extent;
        space->count *= (size_t)extent;
    }
    return !body.failed;
}

/* ---- types ---- */

enum { BIG_ENDIAN_BIT = 0x01, SIGNED_BIT = 0x08 };

static bool is_width(size_t size)
{
    return size == 1 || size == 2 || size == 4 || size == 8;
}

/* All bits are the number. */
static bool read_integer(gonio_i_hdf_cursor body, uint64_t bits, gonio_i_hdf_type *type)
{
    const uint64_t offset = gonio_i_hdf_number(&body, 2);
    const uint64_t precision = gonio_i_hdf_number(&body, 2);
    type->is_signed = (bits & SIGNED_BIT) != 0;
    return !body.failed && is_width(type->size) && offset == 0 && precision == 8 * type->size;
}

/* IEEE 754 of 2, 4 or 8 bytes. */
static bool read_real(gonio_i_hdf_cursor body, uint64_t bits, gonio_i_hdf_type *type)
{
    static const struct {
        size_t size;
        unsigned mantissa, exponent, bias;
    } formats[] = {{2, 10, 5, 15}, {4, 23, 8, 127}, {8, 52, 11, 1023}};
    enum { VAX = 0x40, NORMALISED = 0x20 };
    const uint64_t offset = gonio_i_hdf_number(&body, 2);
    const uint64_t precision = gonio_i_hdf_number(&body, 2);
    const uint64_t exponent_at = gonio_i_hdf_number(&body, 1);
    const uint64_t exponent = gonio_i_hdf_number(&body, 1);
    const uint64_t mantissa_at = gonio_i_hdf_number(&body, 1);
    const uint64_t mantissa = gonio_i_hdf_number(&body, 1);
    const uint64_t bias = gonio_i_hdf_number(&body, 4);
    const bool plain = !body.failed && offset == 0 && precision == 8 * type->size &&
                       mantissa_at == 0 && exponent_at == mantissa && (bits & VAX) == 0 &&
                       (bits & 0x30U) == NORMALISED && bits >> 8 == precision - 1;
    for (size_t k = 0; k < sizeof formats / sizeof *formats; k++) {
        if (plain && type->size == formats[k].size && mantissa == formats[k].mantissa &&
            exponent == formats[k].exponent && bias == formats[k].bias) {
            return true;
        }
    }
    return false;
}

bool gonio_i_hdf_read_type(gonio_i_hdf_cursor body, gonio_i_hdf_type *type)
{
    enum { FIXED_POINT = 0, FLOATING_POINT = 1, TEXT = 3, VARIABLE = 9, HEAP_PLACE = 16 };
    enum { LARGEST = 1 << 16 };
    const uint64_t class = gonio_i_hdf_number(&body, 1) & 0x0FU;
    const uint64_t bits = gonio_i_hdf_number(&body, 3);
    const uint64_t size = gonio_i_hdf_number(&body, 4);
    *type = (gonio_i_hdf_type){.size = (size_t)size, .big_endian = (bits & BIG_ENDIAN_BIT) != 0};
    if (body.failed || size == 0 || size > LARGEST) {
        return false;
    }
    if (class == FIXED_POINT && read_integer(body, bits, type)) {
        type->class = GONIO_I_HDF_INTEGER;
    } else if (class == FLOATING_POINT && read_real(body, bits, type)) {
        type->class = GONIO_I_HDF_REAL;
    } else if (class == TEXT) {
        type->class = GONIO_I_HDF_STRING;
    } else if (class == VARIABLE && (bits & 0x0FU) == 1 && size == HEAP_PLACE) {
        type->class = GONIO_I_HDF_VARIABLE_STRING;
    }
    return true;
}

/* ---- numbers ---- */

static uint64_t read_bits(const gonio_i_hdf_type *type, const unsigned char *stored)
{
    uint64_t bits = 0;
    for (size_t k = 0; k < type->size; k++) {
        bits = bits << 8 | stored[type->big_endian ? k : type->size - 1 - k];
    }
    return bits;
}

static bool is_negative(const gonio_i_hdf_type *type, uint64_t bits)
{
    return type->is_signed && type->size > 0 && bits >> (8 * type->size - 1) != 0;
}

/* The bits of a negative number continue to the left. */
static int64_t negative(const gonio_i_hdf_type *type, uint64_t bits)
{
    const uint64_t left = type->size < 8 ? UINT64_MAX << (8 * type->size) : 0;
    return (int64_t)(bits | left);
}

int64_t gonio_i_hdf_integer(const gonio_i_hdf_type *type, const unsigned char *stored)
{
    const uint64_t bits = read_bits(type, stored);
    return is_negative(type, bits) ? negative(type, bits)
           : bits > INT64_MAX      ? INT64_MAX
                                   : (int64_t)bits;
}

static double half_precision(uint64_t bits)
{
    const int exponent = (int)(bits >> 10 & 0x1FU);
    const double mantissa = (double)(bits & 0x3FFU);
    const double size = exponent == 31  ? (mantissa > 0.0 ? NAN : INFINITY)
                        : exponent == 0 ? ldexp(mantissa, -24)
                                        : ldexp(mantissa + 1024.0, exponent - 25);
    return bits >> 15 != 0 ? -size : size;
}

static double real_number(const gonio_i_hdf_type *type, const unsigned char *stored)
{
    const uint64_t bits = read_bits(type, stored);
    if (type->class == GONIO_I_HDF_INTEGER) {
        return is_negative(type, bits) ? (double)negative(type, bits) : (double)bits;
    }
    if (type->size == sizeof(float)) {
        const uint32_t low = (uint32_t)bits;
        float value = 0.0F;
        memcpy(&value, &low, sizeof value);
        return (double)value;
    }
    double value = 0.0;
    memcpy(&value, &bits, sizeof value);
    return type->size == sizeof value ? value : half_precision(bits);
}

static int32_t small_integer(const gonio_i_hdf_type *type, const unsigned char *stored)
{
    const int64_t value = gonio_i_hdf_integer(type, stored);
    return (int32_t)(value > INT32_MAX ? INT32_MAX : value < INT32_MIN ? INT32_MIN : value);
}

static uint64_t positive_integer(const gonio_i_hdf_type *type, const unsigned char *stored)
{
    const uint64_t bits = read_bits(type, stored);
    return is_negative(type, bits) ? 0 : bits;
}

size_t gonio_i_hdf_width(gonio_i_hdf_number_type wanted)
{
    static const size_t widths[] = {[GONIO_I_HDF_DOUBLE] = sizeof(double),
                                    [GONIO_I_HDF_FLOAT] = sizeof(float),
                                    [GONIO_I_HDF_INT32] = sizeof(int32_t),
                                    [GONIO_I_HDF_UINT64] = sizeof(uint64_t)};
    return widths[wanted];
}

bool gonio_i_hdf_converts(const gonio_i_hdf_type *type, gonio_i_hdf_number_type wanted)
{
    return type->class == GONIO_I_HDF_INTEGER ||
           (type->class == GONIO_I_HDF_REAL &&
            (wanted == GONIO_I_HDF_DOUBLE || wanted == GONIO_I_HDF_FLOAT));
}

void gonio_i_hdf_convert(const gonio_i_hdf_type *type, const unsigned char *stored, size_t count,
                         gonio_i_hdf_number_type wanted, void *values)
{
    for (size_t k = 0; k < count; k++, stored += type->size) {
        switch (wanted) {
        case GONIO_I_HDF_DOUBLE:
            ((double *)values)[k] = real_number(type, stored);
            break;
        case GONIO_I_HDF_FLOAT:
            ((float *)values)[k] = (float)real_number(type, stored);
            break;
        case GONIO_I_HDF_INT32:
            ((int32_t *)values)[k] = small_integer(type, stored);
            break;
        case GONIO_I_HDF_UINT64:
            ((uint64_t *)values)[k] = positive_integer(type, stored);
            break;
        }
    }
}
