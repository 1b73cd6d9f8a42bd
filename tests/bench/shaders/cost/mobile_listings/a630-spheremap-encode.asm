Native code for unnamed FRAG shader (null) with sha1 b467b6cfc468da15335d5df8f211bf91004c800a:
; num_ubos:           0
; num_driver_params:  0
; offsets:
; ubo_state:
;   num_enabled:      0
@in(r0.x)	in0 (wrmask=0x3)
@const(c0.x)	0x41000000, 0xbf800000, 0x3f800000, 0x00000000
bary.f r1.x, 2, r0.x
bary.f r0.z, 0, r0.x
bary.f r0.w, 1, r0.x
bary.f r2.x, 3, r0.x
bary.f r2.y, 4, r0.x
bary.f (ei)r2.z, 5, r0.x
mad.f32 r1.y, c0.x, r1.x, c0.x
(nop3) cmps.f.lt r1.z, c0.y, r1.x
(rpt1)nop
rsq r1.y, r1.y
(ss)(nop3) mul.f r1.y, (2.0), r1.y
mul.f r1.w, r0.z, r1.y
(nop2) mul.f r1.y, r0.w, r1.y
sel.b32 r2.w, r1.w, r1.z, c0.z
sel.b32 r3.x, r1.y, r1.z, c0.w
end
nop
nop
nop
nop
; FRAG: outputs: r2.w (FRAG_RESULT_DATA0) r0.z (FRAG_RESULT_DATA1) r2.x (FRAG_RESULT_DATA2)
; FRAG: inputs: r63.x (VARYING_SLOT_VAR0 slot=32 cm=7,il=0,b=1) r63.x (VARYING_SLOT_VAR1 slot=33 cm=7,il=3,b=1) r0.x (SYSTEM_VALUE_BARYCENTRIC_PERSP_PIXEL slot=52 cm=3,il=6,b=0)
; FRAG prog 30/1: 25 instr, 10 nops, 15 non-nops, 0 mov, 0 cov, 40 dwords
; FRAG prog 30/1: 5 last-baryf, 0 half, 4 full, 4 constlen
; FRAG prog 30/1: 11 cat0, 0 cat1, 10 cat2, 3 cat3, 1 cat4, 0 cat5, 0 cat6, 0 cat7, 
; FRAG prog 30/1: 10 sstall, 1 (ss), 0 systall, 0 (sy), 0 loops
; pos (ij_pixel): r0.x
; data0: r2.w
; data1: r0.z
; data2: r2.x

