/* Denormal numbers: the foot of a wave decays into them, and arithmetic on them is many times slower. */
#ifndef RG_DENORMALS_H
#define RG_DENORMALS_H

/* Makes every thread treat denormal numbers as zero, from here on. */
void rg_flush_denormals(void);

#endif
