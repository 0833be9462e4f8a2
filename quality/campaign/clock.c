/* Loaded before the C library (LD_PRELOAD), makes the clocks of a program go wrong. At the n-th
   reading of a thread they say the true time and, by CAMPAIGN_CLOCK, so many seconds:
     slow     2 n: more than a second has always passed, so that a run saves each generation
     back    -2 n: time goes backwards
     jumps    anything within ten days, forwards and backwards
     ancient -2e9: before 1970 */
#define _GNU_SOURCE
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

static long beside(long n)
{
	const char *kind = getenv("CAMPAIGN_CLOCK");
	if (!kind)
		return 0;
	if (!strcmp(kind, "slow"))
		return 2 * n;
	if (!strcmp(kind, "back"))
		return -2 * n;
	if (!strcmp(kind, "jumps"))
		return (long)((unsigned long)n * 2654435761UL % 1728000UL) - 864000;
	if (!strcmp(kind, "ancient"))
		return -2000000000L;
	return 0;
}

int clock_gettime(clockid_t clock, struct timespec *now)
{
	static __thread long readings;
	int status = (int)syscall(SYS_clock_gettime, clock, now);
	if (!status && (clock == CLOCK_MONOTONIC || clock == CLOCK_REALTIME))
		now->tv_sec += beside(++readings);
	return status;
}
