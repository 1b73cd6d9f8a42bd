0000 00000002 A03C0000  ALU 16 @4 
 0004 00380400 00346B10     1 x:     INTERP_XY              R1.x,  R0.y, Param0  BS:5
 0006 00B80000 20346B10       y:     INTERP_XY              R1.y,  R0.x, Param0  BS:5
 0008 01380400 40146B00       z:     INTERP_XY              __.z,  R0.y, Param0  BS:5
 0010 81B80000 6FF46B00       w:     INTERP_XY              __.w,  R0.x, Param0  BS:5
 0012 01380400 40146C90     2 z:     INTERP_Z               R0.z,  R0.y, Param0  BS:5
 0014 81B80000 6FF46C80       w:     INTERP_Z               __.w,  R0.x, Param0  BS:5
 0016 011FC0FD 200300FD     3 y:     MULADD_IEEE            R0.y,  [0x41000000 8.000000], PV.z, [0x41000000 8.000000]
 0018 809FA8FE 40200690       z:     SETGT_DX10             R1.z,  PV.z, [0xBF800000 -1.000000]
 0020 41000000                                               8.000000 (1090519040)
 0021 BF800000                                               -1.000000 (-1082130432)
 0022 800004FE 60004490     4 t:     RECIPSQRT_IEEE         R0.w,  PV.y
 0024 801FE0FD 00000110     5 x:     MUL_IEEE               R0.x,  [0x40000000 2.000000], PS
 0026 40000000                                               2.000000 (1073741824)
 0028 001FC001 20400110     6 y:     MUL_IEEE               R2.y,  R1.x, PV.x
 0030 801FC401 40000110       z:     MUL_IEEE               R0.z,  R1.y, PV.x
 0032 001F2801 000384FE     7 x:     CNDE_INT               R0.x,  R1.z, 1.0, PV.y
 0034 801F0801 200388FE       y:     CNDE_INT               R0.y,  R1.z, 0, PV.z
0002 C0000000 95200FC8  EXPORT_DONE        PIXEL 0     R0.xy__      ES:3 EOP 
