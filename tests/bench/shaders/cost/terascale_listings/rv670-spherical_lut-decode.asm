0000 00000004 A0240000  ALU 10 @8 
 0008 001F8400 802280FC     1 x:     MULADD_IEEE_sat        R1.x,  R0.y, 0.5, 0.5
 0010 00000400 40201910       z:     MOV                    R1.z,  R0.y
 0012 801F8000 E02280FC       w:     MULADD_IEEE_sat        R1.w,  R0.x, 0.5, 0.5
 0014 001FA0FE 000280FC     2 x:     MULADD_IEEE            R0.x,  PV.x, [0x437F0000 255.000000], 0.5
 0016 801FACFE 600280FC       w:     MULADD_IEEE            R0.w,  PV.w, [0x437F0000 255.000000], 0.5
 0018 437F0000                                               255.000000 (1132396544)
 0020 00000CFE 20001410     3 y:     FLOOR                  R0.y,  PV.w
 0022 800000FE 40001410       z:     FLOOR                  R0.z,  PV.x
 0024 800004FE 00206B10     4 t:     FLT_TO_INT             R1.x,  PV.y
 0026 80000800 20206B10     5 t:     FLT_TO_INT             R1.y,  R0.z
0002 0000000E 80800000  TEX 1 @28 
 0028 00011203 F01F9000 9C800000   LD             R0.xy__, R1.xy_0,  RID:18, SID:0  CT:NNNN 
0004 00000010 A0040000  ALU 2 @32 
 0032 00000000 00201910     6 x:     MOV                    R1.x,  R0.x
 0034 80000400 20201910       y:     MOV                    R1.y,  R0.y
0006 C0008000 94200E88  EXPORT_DONE        PIXEL 0     R1.xyz_      ES:3 EOP 
