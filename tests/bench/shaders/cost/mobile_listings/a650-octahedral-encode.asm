Native code for unnamed FRAG shader (null) with sha1 bc3801e91a9e8d69316b09d71ea3a58a88665b2a:
; num_ubos:           0
; num_driver_params:  0
; offsets:
; ubo_state:
;   num_enabled:      0
@in(r0.x)	in0 (wrmask=0x3)
bary.f r0.z, 0, r0.x
bary.f r0.w, 1, r0.x
bary.f r1.x, 2, (r)r0.x
add.f r1.y, (abs)r0.z, (abs)r0.w
(nop2) cmps.f.lt r1.z, r1.x, (0.0)
(nop3) add.f r1.y, r1.y, (abs)r1.x
(rpt2)nop
rcp r1.y, r1.y
(ss)mul.f r1.w, r0.z, r1.y
(nop2) mul.f r1.y, r0.w, r1.y
add.f r2.z, (1.0), (absneg)r1.w
add.f r2.x, (1.0), (absneg)r1.y
cmps.f.lt r2.y, r1.w, (0.0)
cmps.f.lt r2.w, r1.y, (0.0)
absneg.f r3.w, (neg)r2.z
(nop2) absneg.f r3.x, (neg)r2.x
sel.b32 r3.w, r3.w, r2.w, r2.z
(nop2) sel.b32 r3.x, r3.x, r2.y, r2.x
sel.b32 r3.z, r3.w, r1.z, r1.y
bary.f r1.y, 3, r0.x
sel.b32 r3.y, r3.x, r1.z, r1.w
bary.f r1.z, 4, r0.x
bary.f (ei)r1.w, 5, r0.x
end
nop
nop
nop
nop
nop
nop
nop
nop
; FRAG: outputs: r3.y (FRAG_RESULT_DATA0) r0.z (FRAG_RESULT_DATA1) r1.y (FRAG_RESULT_DATA2)
; FRAG: inputs: r63.x (VARYING_SLOT_VAR0 slot=32 cm=7,il=0,b=1) r63.x (VARYING_SLOT_VAR1 slot=33 cm=7,il=3,b=1) r0.x (SYSTEM_VALUE_BARYCENTRIC_PERSP_PIXEL slot=52 cm=3,il=6,b=0)
; FRAG prog 34/1: 39 instr, 16 nops, 23 non-nops, 0 mov, 0 cov, 64 dwords
; FRAG prog 34/1: 37 last-baryf, 0 half, 4 full, 0 constlen
; FRAG prog 34/1: 17 cat0, 0 cat1, 17 cat2, 4 cat3, 1 cat4, 0 cat5, 0 cat6, 0 cat7, 
; FRAG prog 34/1: 10 sstall, 1 (ss), 0 systall, 0 (sy), 0 loops
; pos (ij_pixel): r0.x
; data0: r3.y
; data1: r0.z
; data2: r1.y

