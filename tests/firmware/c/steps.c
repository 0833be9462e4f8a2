/* Steps an exported network over 100 000 random inputs. Prints the hash of all outputs and the result of the self-test.
 *
 * NETWORK is its name, INPUTS and OUTPUTS are its numbers, HEADER is its file, and INTEGERS is defined without floats. */
#include <stdint.h>
#include HEADER

#define JOIN(a, b) a##b
#define NAME(a, b) JOIN(a, b)

static uint32_t seed, hash;

static uint32_t draw(void)
{
    seed = seed * 1664525u + 1013904223u;
    return seed;
}

static void add_to_hash(uint32_t bits)
{
    hash ^= bits;
    hash = (hash << 5 | hash >> 27) * 0x9E3779B1u;
}

#ifdef INTEGERS
typedef int16_t number;

static number input(void)
{
    return (int16_t)(draw() >> 16);
}

static uint32_t bits(number output)
{
    return (uint16_t)output;
}
#else
typedef float number;

/* In [-2, 2), without rounding. */
static number input(void)
{
    return (float)(draw() >> 8) * (1.0f / 4194304.0f) - 2.0f;
}

static uint32_t bits(number output)
{
    union {
        float real;
        uint32_t bits;
    } word;
    word.real = output;
    return word.bits;
}
#endif

static NAME(NETWORK, _state) state;

static void line(char text[12])
{
    for (int i = 0; i < 8; i++) text[i] = "0123456789abcdef"[hash >> (28 - 4 * i) & 15];
    text[8] = ' ';
    text[9] = (char)('a' + NAME(NETWORK, _selftest)());
    text[10] = '\n';
    text[11] = 0;
}

static void run(char text[12])
{
    number inputs[INPUTS], outputs[OUTPUTS];
    NAME(NETWORK, _init)(&state);
    seed = 1;
    for (int32_t step = 0; step < 100000; step++) {
        for (int i = 0; i < INPUTS; i++) inputs[i] = input();
        NAME(NETWORK, _step)(&state, inputs, outputs);
        for (int i = 0; i < OUTPUTS; i++) add_to_hash(bits(outputs[i]));
    }
    line(text);
}

#if defined(__AVR__)
#include <avr/io.h>

int main(void)
{
    char text[12];
    UCSR0B = 1 << TXEN0;
    run(text);
    for (char *at = text; *at; at++) {
        while (!(UCSR0A & 1 << UDRE0)) {}
        UDR0 = *at;
    }
    while (!(UCSR0A & 1 << UDRE0)) {}
    for (;;) __asm__ volatile("cli\n sleep"); /* ends simavr */
}
#elif defined(__ARM_ARCH_7EM__)
/* Calls the emulator (semihosting). */
static void host(int operation, const void *argument)
{
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void *memset(void *to, int value, __SIZE_TYPE__ count)
{
    for (unsigned char *at = to; count > 0; count--) *at++ = (unsigned char)value;
    return to;
}

void *memcpy(void *to, const void *from, __SIZE_TYPE__ count)
{
    unsigned char *at = to;
    for (const unsigned char *source = from; count > 0; count--) *at++ = *source++;
    return to;
}

void reset(void)
{
    char text[12];
    *(volatile uint32_t *)0xe000ed88 |= 15u << 20; /* the floating-point unit */
    __asm__ volatile("dsb\n isb");
    run(text);
    host(4, text);
    host(0x18, (const void *)0x20026);
    for (;;) {}
}

/* The end of the stack and the first function. */
__attribute__((section(".vectors"), used)) static const struct {
    uint32_t stack;
    void (*reset)(void);
} vectors = {0x20004000u, reset};
#else
#include <stdio.h>

int main(void)
{
    char text[12];
    run(text);
    fputs(text, stdout);
    return 0;
}
#endif
