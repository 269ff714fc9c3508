"""The same crack by another method, which has no mesh inside: the spectral boundary integral of mode I.

Two half-planes, pulled apart by s0, with opening d(x, t) on y = 0, in Fourier's k along x and Laplace's s in time
(Geubelle & Rice 1995, J. Mech. Phys. Solids 43, 1791; here derived from Rayleigh's function):

    stress = s0 - mu |k|/2 F(p) d,  p = s/(|k| c_s),  F = ((2 + p^2)^2 - 4 a_d a_s)/(a_d p^2),  a_d^2 = 1 + (p c_s/c_d)^2,  a_s^2 = 1 + p^2

F grows as p c_d/c_s, which is the radiation mu c_d/(2 c_s^2) ddot; the rest is a convolution over the past of each mode."""

import math

import numpy as np


def kernel(ratio, at):
    """What is left of F without its growth, in time: (2/pi) times the integral of its real part at p = i w, which ends at
    w = ratio = c_d/c_s, times cos(w at); w = ratio sin(angle)."""
    count = 4000
    angle = (np.arange(count) + 0.5) * math.pi / 2 / count
    w = ratio * np.sin(angle)
    real = -((2 - w * w) ** 2 - 4 * np.cos(angle) * np.sqrt(np.maximum(0, 1 - w * w))) / (w * w)
    rows = [np.cos(np.outer(at[k:k + 500], w)) @ real for k in range(0, len(at), 500)]
    return 2 / math.pi * ratio * math.pi / 2 / count * np.concatenate(rows)


def run(material, tension, strength, energy, end, dx, length, part=0.2):
    """Times (s), and the way of the crack (m): what the linear law dissipated, over its energy. Periodic in x; the crack is at
    -length/2 < x < 0 from t = 0 on and can run to 0.3 length; its other end stays. part: of the time in which a wave passes dx,
    the time step."""
    cd, cs = material.dilatational_speed, material.shear_speed
    mu, ratio = material.density * cs**2, cd / cs
    count = 2 * round(length / dx / 2)
    x, dt = (np.arange(count) + 0.5) * dx - count * dx / 2, part * dx / cd
    steps = math.ceil(end / dt)
    k = 2 * math.pi * np.fft.rfftfreq(count, dx)
    known = np.linspace(0, k[-1] * cs * dt * steps, round(50 * k[-1] * cs * dt * steps) + 2)
    values = kernel(ratio, known)
    past = np.stack([mu * k / 2 * k * cs * dt * np.interp(k * cs * dt * n, known, values) for n in range(steps + 1)])
    radiation, separation = mu * ratio / (2 * cs), 2 * energy / strength
    opening, most = np.zeros(count), np.zeros(count)
    ahead, whole = x > 0, x > 0.3 * length
    modes = np.empty((steps, len(k)), complex)
    times, ways = dt * np.arange(1, steps + 1), np.empty(steps)
    for n in range(steps):
        modes[n] = np.fft.rfft(opening)
        pull = tension - np.fft.irfft((past[n:0:-1] * modes[:n]).sum(axis=0) + past[0] * modes[n] / 2, count)
        held = np.where(ahead & (opening < separation), strength * (1 - opening / separation), 0)
        opens = ~ahead | ((opening > 0) | (pull > strength)) & ~whole
        opening = np.maximum(0, opening + dt * np.where(opens, (pull - held) / radiation, 0))
        most = np.maximum(most, opening)
        part_open = np.minimum(most[ahead] / separation, 1)
        ways[n] = np.sum(part_open * (2 - part_open)) * dx
    return times, ways
